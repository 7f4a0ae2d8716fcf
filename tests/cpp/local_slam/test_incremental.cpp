// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// How a node hangs on the nodes before it.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "mapping_fixtures.hpp"
#include "oort/local_slam/incremental_graph_builder.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

using testing::World;

const Pose2 kStep{0.05, 0.0, 0.02};
constexpr int kSteps = 4;

/// A builder that followed a sensor for a few steps from the origin of its local frame.
class LinkTest : public ::testing::Test {
 protected:
  explicit LinkTest(const World& world = testing::make_room()) : world(world) {}

  void follow(const Pose2& T_world_start = {-1.3, -1.05, 0.3}) {
    builder.begin({});
    Pose2 place = T_world_start;
    for (int k = 0; k <= kSteps; ++k) {
      const frsm::Points points = returns_of(to_point_cloud(see(world, place, 0.1 * k)));
      node = builder.track(points, 0.1 * k, k == 0 ? Pose2{} : kStep);
      place = place * kStep;
      if (k > 0) motion = motion * kStep;
    }
  }

  /// The verdict where the match differs from what odometry says by `T_odometry_match`.
  Rejection rejection(const Pose2& T_odometry_match) {
    return builder.make_edge({}, node.T_local_sensor * inverse(T_odometry_match), node, false).rejection;
  }

  /// Takes new parameters.
  void restart() {
    builder = IncrementalGraphBuilder(parameters);
    follow();
  }

  World world;
  Parameters parameters = testing::documented_parameters();
  MatchFilteringParameters& filter = parameters.incremental_graph_builder.frsm_matcher.match_filtering;
  IncrementalGraphBuilder builder{parameters};
  TrackedScan node;
  Pose2 motion;
};

TEST_F(LinkTest, FollowsTheSensor) {
  follow();
  EXPECT_TRUE(node.usable()) << to_string(node.rejection);
  EXPECT_GT(node.inlier_ratio, 0.9);
  EXPECT_NEAR(node.T_local_sensor.x, motion.x, 0.005);
  EXPECT_NEAR(node.T_local_sensor.y, motion.y, 0.005);
  EXPECT_NEAR(node.T_local_sensor.theta, motion.theta, 0.003);
}

TEST_F(LinkTest, MatchThatAgreesWithOdometryIsBelieved) {
  follow();
  const MatchedEdge edge = builder.make_edge({}, motion, node, false);
  EXPECT_EQ(edge.rejection, Rejection::kNone);
  EXPECT_DOUBLE_EQ(edge.T_anchor_node.x, node.T_local_sensor.x);
  EXPECT_EQ(edge.covariance, edge.covariance.transpose());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(edge.covariance).eigenvalues().minCoeff(), 0.0);
}

TEST_F(LinkTest, DocumentedLimits) {
  EXPECT_DOUBLE_EQ(filter.x_min_accept, -0.05);
  EXPECT_DOUBLE_EQ(filter.x_max_accept, 0.12);
  EXPECT_DOUBLE_EQ(filter.y_abs_accept, 0.11);
  EXPECT_DOUBLE_EQ(filter.theta_abs_accept, 0.07);
  EXPECT_DOUBLE_EQ(filter.min_accept_score, 0.45);
}

TEST_F(LinkTest, MatchThatContradictsOdometryIsRefusedWithItsReason) {
  follow();
  constexpr double kHair = 1e-9;
  for (const auto& [inside, outside, reason] : std::vector<std::tuple<Pose2, Pose2, Rejection>>{
           {{0.12 - kHair, 0.0, 0.0}, {0.12 + kHair, 0.0, 0.0}, Rejection::kX},
           {{-0.05 + kHair, 0.0, 0.0}, {-0.05 - kHair, 0.0, 0.0}, Rejection::kX},
           {{0.0, 0.11 - kHair, 0.0}, {0.0, 0.11 + kHair, 0.0}, Rejection::kY},
           {{0.0, -0.11 + kHair, 0.0}, {0.0, -0.11 - kHair, 0.0}, Rejection::kY},
           {{0.0, 0.0, 0.07 - kHair}, {0.0, 0.0, 0.07 + kHair}, Rejection::kTheta},
           {{0.0, 0.0, -0.07 + kHair}, {0.0, 0.0, -0.07 - kHair}, Rejection::kTheta},
       }) {
    EXPECT_EQ(rejection(inside), Rejection::kNone) << to_string(reason);
    EXPECT_EQ(rejection(outside), reason);
  }
}

TEST_F(LinkTest, DifferencesAreMeasuredAlongTheAxesOfWhereOdometryPutsTheNode) {
  follow();
  const double turned = node.T_local_sensor.theta;
  ASSERT_GT(turned, 0.05);
  // 0.1199 m forward of the odometry's pose is inside; along the axes of the anchor it would not be aside of it.
  const Pose2 forward{0.1199, 0.0, 0.0};
  EXPECT_EQ(rejection(forward), Rejection::kNone);
  filter.y_abs_accept = 1e-6;
  restart();
  EXPECT_EQ(rejection(forward), Rejection::kNone);
}

TEST_F(LinkTest, MatchWithFewHitsIsRefused) {
  follow();
  const double hits = node.inlier_ratio;
  filter.min_accept_score = hits;
  restart();
  EXPECT_EQ(rejection({}), Rejection::kNone);
  filter.min_accept_score = hits + 1e-9;
  restart();
  EXPECT_EQ(rejection({}), Rejection::kScore);
}

TEST_F(LinkTest, WithoutAMatchTheReasonIsTheMatchersStatus) {
  follow();
  node = builder.track({}, 1.0, kStep);
  EXPECT_FALSE(node.usable());
  EXPECT_EQ(builder.make_edge({}, motion * kStep, node, false).rejection, Rejection::kEmptyScan);
  node = builder.track({{1.0, 0.0}, {1.0, 0.1}, {1.0, 0.2}}, 1.1, kStep);
  EXPECT_EQ(builder.make_edge({}, motion * kStep * kStep, node, false).rejection, Rejection::kTooFewPoints);
}

TEST_F(LinkTest, CorrectionCountsForTheNextScan) {
  follow();
  const Pose2 elsewhere = node.T_local_sensor * Pose2{0.0, 0.04, 0.0};
  builder.correct(elsewhere);
  const TrackedScan blind = builder.track({}, 1.0, kStep);  // carried by odometry alone
  const Pose2 expected = elsewhere * kStep;
  EXPECT_NEAR(blind.T_local_sensor.x, expected.x, 1e-12);
  EXPECT_NEAR(blind.T_local_sensor.y, expected.y, 1e-12);
}

TEST_F(LinkTest, BeginStartsAFreshLocalMapAtAPose) {
  follow();
  const Pose2 start{7.0, -2.0, 1.0};
  builder.begin(start);
  const TrackedScan first = builder.track(returns_of(to_point_cloud(see(world, {}, 5.0))), 5.0, {});
  EXPECT_DOUBLE_EQ(first.T_local_sensor.x, start.x);
  EXPECT_DOUBLE_EQ(first.T_local_sensor.theta, start.theta);
  EXPECT_FALSE(first.usable());
}

TEST_F(LinkTest, ConstantModelGivesOdometryLinksTheDocumentedCovariance) {
  const Eigen::Matrix3d covariance = builder.odometry_covariance({3.0, 1.0, 0.5});
  EXPECT_EQ(covariance, Eigen::Matrix3d(Eigen::Vector3d(0.02, 0.02, 0.01).asDiagonal()));
}

TEST_F(LinkTest, MotionModelGrowsWithTheWay) {
  set_parameter(parameters, "incremental_graph_builder.odometry_model", std::string("motion"));
  builder = IncrementalGraphBuilder(parameters);
  const Eigen::Matrix3d one = builder.odometry_covariance({1.0, 0.0, 0.0});
  const Eigen::Matrix3d four = builder.odometry_covariance({4.0, 0.0, 0.0});
  const Eigen::Matrix3d none = builder.odometry_covariance({});
  EXPECT_NEAR((four - none)(0, 0), 4.0 * (one - none)(0, 0), 1e-12);
  EXPECT_NEAR((four - none)(2, 2), 4.0 * (one - none)(2, 2), 1e-12);
  EXPECT_GT(none(0, 0), 0.0);
  const OdometryNoiseParameters& noise = parameters.incremental_graph_builder.odometry_noise;
  EXPECT_NEAR(one(0, 0), std::pow(noise.translation_per_meter, 2) + std::pow(noise.translation_floor, 2), 1e-15);
  const Eigen::Matrix3d turn = builder.odometry_covariance({0.0, 0.0, -1.0});
  EXPECT_NEAR(turn(0, 0), std::pow(noise.translation_per_radian, 2) + std::pow(noise.translation_floor, 2), 1e-15);
  EXPECT_NEAR(turn(2, 2), std::pow(noise.rotation_per_radian, 2) + std::pow(noise.rotation_floor, 2), 1e-15);
}

TEST_F(LinkTest, OdometryFarOffAGoodMatchContradictsIt) {
  const auto contradicts = [&](const Pose2& T_odometry_match) {
    return builder.make_edge({}, node.T_local_sensor * inverse(T_odometry_match), node, false).contradicts_odometry;
  };
  follow();
  filter.y_abs_accept = filter.theta_abs_accept = filter.x_max_accept = 2.0;
  filter.x_min_accept = -2.0;
  EXPECT_FALSE(contradicts({0.5, 0.0, 0.0}));  // the constant model does not know
  set_parameter(parameters, "incremental_graph_builder.odometry_model", std::string("motion"));
  restart();
  EXPECT_FALSE(contradicts({}));
  const double sigma = std::sqrt(builder.odometry_covariance(motion)(0, 0));
  EXPECT_FALSE(contradicts({2.0 * sigma, 0.0, 0.0}));
  EXPECT_TRUE(contradicts({10.0 * sigma, 0.0, 0.0}));
  EXPECT_TRUE(contradicts({0.0, -10.0 * sigma, 0.0}));
  EXPECT_TRUE(contradicts({0.0, 0.0, 1.0}));
  EXPECT_TRUE(contradicts({2.1, 0.0, 0.0}));           // refused for this alone
  node.inlier_ratio = filter.min_accept_score - 0.01;  // a poor match says nothing against odometry
  EXPECT_FALSE(contradicts({10.0 * sigma, 0.0, 0.0}));
}

TEST(LearnedOdometry, FollowsHowFarMatchesAreFromIt) {
  const OdometryModel model{0.1, 0.05, 0.1, 0.15, 0.005, 0.005};
  const Pose2 step{0.2, 0.0, 0.1};
  const double sigma = std::sqrt(model.covariance(step)(0, 0));
  const double sigma_theta = std::sqrt(model.covariance(step)(2, 2));
  const auto learned = [&](double share, double least) {
    LearnedOdometry odometry(model, least);
    for (int k = 0; k < 400; ++k) odometry.learn(step, {share * sigma, -share * sigma, share * sigma_theta});
    return odometry;
  };
  for (const double share : {0.3, 0.5, 2.0}) {
    const LearnedOdometry odometry = learned(share, 0.2);
    EXPECT_NEAR(odometry.translation_factor(), share, 0.05 * share);
    EXPECT_NEAR(odometry.rotation_factor(), share, 0.05 * share);
    EXPECT_NEAR(odometry.covariance(step)(0, 0), std::pow(odometry.translation_factor() * sigma, 2), 1e-12);
  }
  EXPECT_DOUBLE_EQ(learned(0.01, 0.2).translation_factor(), 0.2);  // no base is perfect
  EXPECT_DOUBLE_EQ(learned(50.0, 0.2).rotation_factor(), 3.0);
  EXPECT_DOUBLE_EQ(learned(0.01, 1.0).rotation_factor(), 1.0);  // nothing is learned
}

TEST(LearnedOdometry, LearnsNothingFromAlmostNoMotion) {
  for (const Pose2& tiny : {Pose2{0.0, 0.0, 1e-313}, Pose2{1e-170, 0.0, 0.0}, Pose2{1e-313, 1e-313, -5e-324}}) {
    LearnedOdometry odometry(OdometryModel{0.05, 0.05, 0.05, 0.05, 0.01, 0.01}, 0.2);
    for (int k = 0; k < 50; ++k) odometry.learn(tiny, {0.3, -0.2, 3.0});
    const Pose2 corrected = odometry.corrected({1.0, 0.0, 1.0});
    EXPECT_TRUE(is_finite(corrected));
    EXPECT_NEAR(corrected.x, 1.0, 0.2);
    EXPECT_NEAR(corrected.theta, 1.0, 0.2);
  }
}

TEST(LearnedOdometry, FindsTheScalesOfWayAndTurn) {
  LearnedOdometry odometry({0.1, 0.05, 0.1, 0.15, 0.005, 0.005}, 0.2);
  const Pose2 straight{0.2, 0.0, 0.0},
      turn{0.0, 0.0, 0.6};  // measured; the wheels are 4 % too small, the base too wide
  for (int k = 0; k < 200; ++k) {
    for (const Pose2& measured : {straight, turn}) {
      const Pose2 corrected = odometry.corrected(measured);
      odometry.learn(corrected, between(corrected, Pose2{0.96 * measured.x, 0.0, 1.05 * measured.theta}));
    }
  }
  EXPECT_NEAR(odometry.corrected(straight).x, 0.96 * straight.x, 0.01 * straight.x);
  EXPECT_NEAR(odometry.corrected(turn).theta, 1.05 * turn.theta, 0.01 * turn.theta);
  // What counts forwards when it goes backwards is not to be mended by a scale.
  for (int k = 0; k < 200; ++k) odometry.learn(straight, between(straight, Pose2{-0.2, 0.0, 0.0}));
  EXPECT_NEAR(odometry.corrected(straight).x, 0.9 * straight.x, 1e-9);
}

TEST(LearnedOdometry, ASingleSlipSaysLittle) {
  LearnedOdometry odometry({0.1, 0.05, 0.1, 0.15, 0.005, 0.005}, 0.2);
  for (int k = 0; k < 200; ++k) odometry.learn({0.2, 0.0, 0.0}, {0.01, 0.0, 0.01});
  odometry.learn({0.2, 0.0, 0.0}, {0.8, 0.0, 0.0});
  EXPECT_LT(odometry.translation_factor(), 0.6);
}

TEST_F(LinkTest, WhatIsLearnedOfOdometryHoldsUnlessScansSpeakAgainstIt) {
  set_parameter(parameters, "incremental_graph_builder.odometry_model", std::string("motion"));
  set_parameter(parameters, "incremental_graph_builder.odometry_noise.least_learned", 0.2);
  restart();
  const Eigen::Matrix3d configured = builder.odometry_covariance(motion);
  for (int k = 0; k < 50; ++k) builder.make_edge({}, motion, node, false);
  EXPECT_LT(builder.odometry_covariance(motion)(0, 0), 0.5 * configured(0, 0));
  EXPECT_LT(builder.odometry_covariance(motion, Rejection::kTooFewPoints)(0, 0), 0.5 * configured(0, 0));
  EXPECT_TRUE(builder.odometry_covariance(motion, Rejection::kLowHits).isApprox(configured));
}

TEST_F(LinkTest, OdometryThatIsLinkedDoesNotCountTwice) {
  set_parameter(parameters, "incremental_graph_builder.odometry_model", std::string("motion"));
  restart();
  const Eigen::Matrix3d once = builder.make_edge({}, motion, node, true).covariance.inverse();
  const Eigen::Matrix3d both = builder.make_edge({}, motion, node, false).covariance.inverse();
  const Eigen::Matrix3d odometry = builder.odometry_covariance(motion).inverse();
  // Up to what is added to the heading afterwards, the two differ by odometry's information.
  EXPECT_NEAR((both - once)(0, 0), odometry(0, 0), 0.1 * odometry(0, 0));
  EXPECT_NEAR((both - once)(1, 1), odometry(1, 1), 0.1 * odometry(1, 1));
}

/// Between two parallel walls without end nothing tells how far along one is.
class CorridorTest : public LinkTest {
 protected:
  CorridorTest() : LinkTest({{{-100.0, 0.9}, {100.0, 0.9}}, {{100.0, -0.9}, {-100.0, -0.9}}}) {}
};

TEST_F(CorridorTest, WhatTheMatchDoesNotSeeIsLeftToOdometry) {
  set_parameter(parameters, "incremental_graph_builder.odometry_model", std::string("motion"));
  set_parameter(parameters, "incremental_graph_builder.odometry_noise.translation_floor", 0.14);  // far from sure
  parameters.incremental_graph_builder.frsm_matcher.match_error_xy = 0.0;  // what the match itself shows
  builder = IncrementalGraphBuilder(parameters);
  follow({0.0, 0.0, 0.5});  // the corridor's axis is at -0.5 rad in the local frame
  const MatchedEdge edge = builder.make_edge({}, motion, node, false);
  EXPECT_EQ(edge.rejection, Rejection::kNone);
  const Eigen::Vector2d along(std::cos(0.5), -std::sin(0.5));
  const Eigen::Vector2d across(std::sin(0.5), std::cos(0.5));
  const Eigen::Matrix2d xy = edge.covariance.topLeftCorner<2, 2>();
  const double variance = builder.odometry_covariance(motion)(0, 0);
  EXPECT_NEAR(along.dot(xy * along), variance, 0.1 * variance);
  EXPECT_LT(across.dot(xy * across), 0.1 * variance);
  // and the pose follows odometry along it
  EXPECT_NEAR(along.dot((edge.T_anchor_node.translation() - motion.translation())), 0.0, 0.01);
}

TEST_F(CorridorTest, OfAContradictionOdometryIsTakenForWhatTheMatchDoesNotSee) {
  set_parameter(parameters, "incremental_graph_builder.odometry_model", std::string("motion"));
  filter.y_abs_accept = filter.x_max_accept = 2.0;
  filter.x_min_accept = -2.0;
  builder = IncrementalGraphBuilder(parameters);
  follow({0.0, 0.0, 0.0});
  const Pose2 odometry = node.T_local_sensor * Pose2{1.0, 0.6, 0.0};  // 1 m more along the walls, 0.6 m across
  const MatchedEdge edge = builder.make_edge({}, odometry, node, false);
  EXPECT_TRUE(edge.contradicts_odometry);
  EXPECT_NEAR(edge.T_anchor_node_weighed.x, odometry.x, 0.3);
  EXPECT_NEAR(edge.T_anchor_node_weighed.y, edge.T_anchor_node.y, 0.1);
}

TEST_F(CorridorTest, CovarianceIsAlongTheAxesOfTheAnchor) {
  follow({0.0, 0.0, 0.0});
  const Pose2 T_local_anchor{0.0, 0.0, 0.5 * testing::kPi};
  const MatchedEdge straight = builder.make_edge({}, motion, node, false);
  const MatchedEdge turned = builder.make_edge(T_local_anchor, between(T_local_anchor, motion), node, false);
  EXPECT_NEAR(turned.covariance(1, 1), straight.covariance(0, 0), 1e-9);
  EXPECT_NEAR(turned.covariance(0, 0), straight.covariance(1, 1), 1e-9);
  EXPECT_GT(straight.covariance(0, 0), 5.0 * straight.covariance(1, 1));
}

}  // namespace
}  // namespace oort
