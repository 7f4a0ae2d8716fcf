// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// The back end after Cartographer: Huber's loss, and landmarks seen between nodes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "oort/geometry/errors.hpp"
#include "oort/graph/internal/graph_costs.hpp"
#include "oort/graph/landmarks.hpp"

namespace oort {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

class LandmarkTest : public testing::Test {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Pose2 random_pose() { return {uniform(-5.0, 5.0), uniform(-5.0, 5.0), uniform(-1.4, 1.4)}; }

  static Eigen::Matrix3d variances(double xy, double theta) {
    return Eigen::Vector3d(xy * xy, xy * xy, theta * theta).asDiagonal();
  }

  /// A drive along an arc whose links measure every step turned a little too far.
  void make_drive(std::size_t nodes, double drift, double sigma = 0.02) {
    const Pose2 step{0.5, 0.0, 0.1};
    truth = {{}};
    graph = {};
    graph.nodes.push_back({0, {}});
    for (std::uint64_t k = 1; k < nodes; ++k) {
      truth.push_back(truth.back() * step);
      const Pose2 measured{step.x, step.y, step.theta + drift};
      graph.nodes.push_back({k, graph.nodes.back().pose * measured});
      graph.edges.push_back({k, k - 1, k, {0.0, k, measured, variances(sigma, sigma), ConstraintType::kLaser}});
    }
  }

  double worst_error() const {
    double worst = 0.0;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      worst = std::max(worst, (graph.nodes[k].pose.translation() - truth[k].translation()).norm());
    }
    return worst;
  }

  /// What is seen of a landmark from between two nodes.
  LandmarkObservation seen(std::uint64_t landmark, const Pose2& T_map_landmark, std::uint64_t node,
                           double fraction) const {
    const Pose2 sensor = interpolate(truth[node], truth[node + 1], fraction);
    return {landmark, node, node + 1, fraction, between(sensor, T_map_landmark), variances(0.02, 0.02)};
  }

  std::vector<Pose2> truth;
  Graph graph;
  OptimizerOptions options;
  Landmarks landmarks;

 private:
  std::mt19937 random_{7};
};

TEST_F(LandmarkTest, JacobiansMatchCentralDifferences) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix3d W;
  W << 1.0, 0.3, -0.2, 0.0, 2.0, 0.5, 0.0, 0.0, 3.0;
  for (int trial = 0; trial < 40; ++trial) {
    double poses[3][3];
    for (auto& pose : poses) {
      const Pose2 p = random_pose();
      pose[0] = p.x, pose[1] = p.y, pose[2] = p.theta;
    }
    const LandmarkCost observation(uniform(0.0, 1.0), {0.3, 0.2, 0.1}, W);
    const RelativePoseCost link({0.3, 0.2, 0.1}, W);
    const double* blocks[] = {poses[0], poses[1], poses[2]};
    const auto check = [&](const ceres::CostFunction& cost) {
      const std::size_t count = cost.parameter_block_sizes().size();
      RowMajor3 jacobians[3];
      double* out[] = {jacobians[0].data(), jacobians[1].data(), jacobians[2].data()};
      Eigen::Vector3d residuals, plus, minus;
      ASSERT_TRUE(cost.Evaluate(blocks, residuals.data(), out));
      for (std::size_t b = 0; b < count; ++b) {
        for (int k = 0; k < 3; ++k) {
          const double at = poses[b][k];
          poses[b][k] = at + kStep;
          cost.Evaluate(blocks, plus.data(), nullptr);
          poses[b][k] = at - kStep;
          cost.Evaluate(blocks, minus.data(), nullptr);
          poses[b][k] = at;
          EXPECT_LT((jacobians[b].col(k) - (plus - minus) / (2.0 * kStep)).norm(), 1e-6);
        }
      }
    };
    check(observation);
    check(link);
  }
}

TEST_F(LandmarkTest, CorrectTheDrive) {
  make_drive(30, 0.01);
  const double before = worst_error();
  const Pose2 tag{3.0, 4.0, 1.0}, other{-1.0, 6.0, -2.0};
  std::vector<LandmarkObservation> observations;
  for (const std::uint64_t node : {0u, 9u, 19u, 28u}) {
    observations.push_back(seen(5, tag, node, 0.3));
    observations.push_back(seen(2, other, node, 0.9));
  }
  const OptimizerSummary summary = optimize_with_landmarks(graph, observations, landmarks, options);
  EXPECT_TRUE(summary.converged) << summary.message;
  EXPECT_LT(worst_error(), 0.1 * before);
  ASSERT_EQ(landmarks.size(), 2u);
  EXPECT_LT(between(landmarks.at(5), tag).translation().norm(), 0.05);
  EXPECT_LT(between(landmarks.at(2), other).translation().norm(), 0.05);
  EXPECT_EQ(graph.nodes[0].pose.x, 0.0) << "the first node keeps its pose";
}

TEST_F(LandmarkTest, OneSeenAtANodeAndOneSeenOnceChangeNothingElse) {
  make_drive(5, 0.0);
  const Pose2 tag{1.0, 1.0, 0.5};
  LandmarkObservation at_node = seen(1, tag, 2, 0.0);
  at_node.after = at_node.before;
  optimize_with_landmarks(graph, {at_node}, landmarks, options);
  EXPECT_LT(between(landmarks.at(1), tag).translation().norm(), 1e-6);
  EXPECT_LT(worst_error(), 1e-6);
}

TEST_F(LandmarkTest, RefusesWhatItCannotUse) {
  make_drive(5, 0.01);
  const LandmarkObservation good = seen(1, {1.0, 1.0, 0.5}, 2, 0.5);
  const Pose2 before = graph.nodes[4].pose;
  const auto refused = [&](const LandmarkObservation& observation) {
    EXPECT_THROW(optimize_with_landmarks(graph, {good, observation}, landmarks, options), InputError);
  };
  LandmarkObservation bad = good;
  bad.after = 5;
  refused(bad);
  bad = good;
  bad.fraction = 1.1;
  refused(bad);
  bad = good;
  bad.T_sensor_landmark.x = std::nan("");
  refused(bad);
  bad = good;
  bad.covariance.setZero();
  refused(bad);
  EXPECT_EQ(graph.nodes[4].pose.x, before.x);
  EXPECT_TRUE(landmarks.empty());
}

class HuberTest : public LandmarkTest {
 protected:
  HuberTest() { options.robust_kernel = RobustKernel::kHuber; }

  void close(std::uint64_t i, std::uint64_t j, const Pose2& T_i_j) {
    graph.switchable_edges.push_back(
        {1000 + i, i, j, {0.0, j, T_i_j, variances(0.02, 0.02), ConstraintType::kLaser}, 1.0});
  }
};

TEST_F(HuberTest, AgreesWithTheSwitchesWhereAllAgree) {
  make_drive(20, 0.003);
  close(0, 19, between(truth[0], truth[19]));
  close(3, 15, between(truth[3], truth[15]));
  Graph other = graph;
  OptimizerOptions switches;
  switches.switchable_constraint_scale = 1e6;
  const OptimizerSummary summary = optimize(graph, options);
  optimize(other, switches);
  EXPECT_TRUE(summary.converged);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_LT(between(graph.nodes[k].pose, other.nodes[k].pose).translation().norm(), 1e-3);
  }
  EXPECT_EQ(graph.switchable_edges[0].switch_value, 1.0);
  EXPECT_LT(summary.final_cost, summary.initial_cost);
}

TEST_F(HuberTest, AFalseClosurePullsLessButPulls) {
  const auto bent_with = [&](double huber_scale) {
    make_drive(20, 0.0, 0.002);
    close(0, 19, between(truth[0], truth[19]) * Pose2{3.0, 0.0, 0.0});
    options.huber_scale = huber_scale;
    optimize(graph, options);
    return worst_error();
  };
  const double bent = bent_with(2.0);
  EXPECT_GT(bent, 0.02);
  EXPECT_LT(graph.switchable_edges[0].switch_value, 0.5);
  EXPECT_GT(bent_with(1000.0), 3.0 * bent) << "as good as no loss";
  EXPECT_EQ(graph.switchable_edges[0].switch_value, 1.0);
}

TEST_F(HuberTest, TheSameGraphGivesTheSameBits) {
  make_drive(40, 0.01);
  close(0, 39, between(truth[0], truth[39]));
  Graph other = graph;
  optimize(graph, options);
  optimize(other, options);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_EQ(graph.nodes[k].pose.x, other.nodes[k].pose.x);
    EXPECT_EQ(graph.nodes[k].pose.theta, other.nodes[k].pose.theta);
  }
}

TEST_F(HuberTest, RefusesAScaleThatIsNone) {
  make_drive(3, 0.0);
  options.huber_scale = 0.0;
  EXPECT_THROW(optimize(graph, options), ParameterError);
}

}  // namespace
}  // namespace oort
