// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/reduced_graph.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "oort/graph/graph_check.hpp"

namespace oort {
namespace {

/// Chains of edges whose errors are known.
class Chains {
 public:
  /// `share` of an edge's covariance comes from each of its nodes, which its neighbours then have too.
  Chains(ConstraintType type, double share) : type_(type), share_(share) {}

  Map make(std::uint64_t edges) {
    Map map;
    Pose2 truth, measured, error = noise(share_);
    const Pose2 step{0.2, 0.05, 0.3};
    add_node(map, measured);
    for (std::uint64_t node = 1; node <= edges; ++node) {
      const Pose2 next_error = noise(share_);
      const Pose2 drift = noise(1.0 - 2.0 * share_);
      const Pose2 T = inverse(error) * step * next_error * drift;
      measured = measured * T;
      truth = truth * step;
      add_node(map, measured);
      map.graph.edges.push_back({node - 1, node - 1, node, {0.0, node, T, covariance(), type_}});
      error = next_error;
    }
    truth_ = truth;
    return map;
  }

  /// Where the last node truly is as seen from the first.
  const Pose2& truth() const { return truth_; }

 private:
  static Eigen::Matrix3d covariance() {
    return Eigen::Vector3d(kSigma[0], kSigma[1], kSigma[2]).cwiseAbs2().asDiagonal();
  }

  Pose2 noise(double share) {
    const double scale = std::sqrt(share);
    return {scale * kSigma[0] * normal_(random_), scale * kSigma[1] * normal_(random_),
            scale * kSigma[2] * normal_(random_)};
  }

  static void add_node(Map& map, const Pose2& pose) {
    const std::uint64_t id = map.graph.nodes.size();
    map.graph.nodes.push_back({id, pose});
    PointCloud cloud;
    cloud.id = id;
    cloud.time = static_cast<double>(id);
    map.clouds.push_back(std::move(cloud));
  }

  static constexpr double kSigma[] = {0.004, 0.003, 0.008};
  ConstraintType type_;
  double share_;
  Pose2 truth_;
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

/// Leaves each `stride`-th node.
Map reduced(const Map& map, std::uint64_t stride) {
  TrajectorySegments segments;
  std::vector<bool> kept;
  for (const Node& node : map.graph.nodes) {
    segments.add(node.id == 0, true, node.pose);
    kept.push_back(node.id % stride == 0);
  }
  Map result;
  result.graph = reduce(map, segments, kept).graph;
  for (const Node& node : map.graph.nodes) {
    if (kept[node.id]) result.clouds.push_back(map.clouds[node.id]);
  }
  return result;
}

/// Mean normalised squared error of the one edge that is left; 3 is honest.
double mean_nees(Chains chains, std::uint64_t edges, std::uint64_t first_stride) {
  constexpr int kRuns = 500;
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const Map map = reduced(reduced(chains.make(edges), first_stride), edges / first_stride);
    EXPECT_EQ(map.graph.edges.size(), 1u);
    const Constraint& folded = map.graph.edges.front().constraint;
    const Pose2 error = between(chains.truth(), folded.T_i_j);
    const Eigen::Vector3d e(error.x, error.y, error.theta);
    const Eigen::Matrix3d covariance = rotate_covariance(folded.covariance, -folded.T_i_j.theta);
    sum += e.dot(covariance.ldlt().solve(e));
  }
  return sum / kRuns;
}

TEST(ReducedGraph, AFoldedChainOfMatchesIsAsUnsureAsItErrs) {
  const Chains chains(ConstraintType::kLaser, 0.33);
  for (const std::uint64_t edges : {2, 5, 12}) {
    EXPECT_NEAR(mean_nees(chains, edges, 1), 3.0, 0.5) << edges;
  }
}

TEST(ReducedGraph, AFoldedChainOfOdometryIsAsUnsureAsItErrs) {
  const Chains chains(ConstraintType::kOdometry, 0.0);
  for (const std::uint64_t edges : {2, 5, 12}) {
    EXPECT_NEAR(mean_nees(chains, edges, 1), 3.0, 0.5) << edges;
  }
}

// What was folded is folded again, day after day: it must not become surer than it is.
TEST(ReducedGraph, WhatWasFoldedBeforeIsStillAsUnsureAsItErrs) {
  const Chains chains(ConstraintType::kLaser, 0.33);
  for (const std::uint64_t first_stride : {2, 4, 8}) {
    EXPECT_NEAR(mean_nees(chains, 32, first_stride), 3.0, 0.7) << first_stride;
  }
}

// Whatever covariances a map may have: one that is folded can be saved and loaded again.
TEST(ReducedGraph, AFoldedEdgeIsSound) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-9.0, 6.0), angle(-3.0, 3.0);
  int folded = 0;
  for (int run = 0; run < 3000; ++run) {
    Map map = Chains(ConstraintType::kLaser, 0.33).make(2 + run % 5);
    for (Edge& edge : map.graph.edges) {
      const Eigen::Vector3d sigmas(std::pow(10.0, exponent(random)), std::pow(10.0, exponent(random)),
                                   std::pow(10.0, std::min(0.0, exponent(random))));
      const Eigen::Matrix3d diagonal = sigmas.cwiseAbs2().asDiagonal();
      edge.constraint.covariance = rotate_covariance(diagonal, angle(random));
      if (find_covariance_defect(edge.constraint.covariance)) edge.constraint.covariance = diagonal;
    }
    const Graph graph = reduced(map, map.graph.edges.size()).graph;
    for (const Edge& edge : graph.edges) {
      EXPECT_EQ(find_covariance_defect(edge.constraint.covariance), std::nullopt) << edge.constraint.covariance;
      ++folded;
    }
  }
  EXPECT_EQ(folded, 3000);
}

}  // namespace
}  // namespace oort
