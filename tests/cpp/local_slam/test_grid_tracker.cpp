// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// cartographer_matcher: following a sensor on probability grids, and what is believed of it.
#include <gtest/gtest.h>

#include <cmath>

#include "mapping_fixtures.hpp"
#include "oort/local_slam/grid_scan_tracker.hpp"
#include "oort/local_slam/incremental_graph_builder.hpp"
#include "oort/local_slam/match_gates.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

constexpr ProbabilityGridParameters kGrid{0.05, false, 0.55, 0.49};

class GridTrackerTest : public ::testing::Test {
 protected:
  GridTrackerTest() { builder.scanmatcher = "cartographer_matcher"; }

  static frsm::Points seen(const Pose2& place, const testing::Sensor& sensor = {}) {
    return returns_of(to_point_cloud(testing::see(testing::make_room(), place, 0.0, sensor)));
  }

  /// Follows the sensor for 3.2 m along the laps, with an odometry that takes each step for longer and turned, and
  /// returns by how much the tracker's way differs from the true one at most [m]. Odometry alone is off by 1 m.
  double follow(std::size_t stride, const testing::Sensor& sensor = {}) const {
    const std::vector<Pose2> truth = testing::laps(1.0);
    const std::vector<Pose2> odometry = testing::odometry_of(truth, 0.3, 0.3);
    GridScanTracker tracker(p);
    tracker.reset({});
    double worst = 0.0;
    for (std::size_t k = 0; k <= 80; k += stride) {
      const Pose2 step = k == 0 ? Pose2{} : between(odometry[k - stride], odometry[k]);
      const TrackedScan tracked = tracker.track(seen(truth[k], sensor), 0.1 * static_cast<double>(k), {step}, {});
      EXPECT_EQ(tracked.usable(), k > 0) << k << ": " << to_string(tracked.rejection);
      worst = std::max(worst, between(between(truth[0], truth[k]), tracked.T_local_sensor).translation().norm());
    }
    return worst;
  }

  Parameters parameters;
  IncrementalGraphBuilderParameters& builder = parameters.incremental_graph_builder;
  CartographerMatcherParameters& p = builder.cartographer_matcher;
};

TEST_F(GridTrackerTest, FollowsTheSensorAgainstItsOdometry) {
  EXPECT_LT(follow(1), 0.1);
  EXPECT_LT(follow(5), 0.1) << "from node to node";
}

TEST_F(GridTrackerTest, FollowsToACellWithoutRefinement) {
  p.use_ceres_refinement = false;
  EXPECT_LT(follow(5), 0.15);
}

/// Points of a sparse scan fit a 1 cm grid best where the last scan's were, so the second stage is tried on a dense
/// one.
TEST_F(GridTrackerTest, FollowsWithTwoStages) {
  const testing::Sensor dense{720, testing::kPi, 5.0};
  p.use_second_stage_matcher = true;
  EXPECT_LT(follow(1, dense), 0.06);
  p.use_ceres_refinement = false;
  EXPECT_LT(follow(5, dense), 0.1);
}

TEST_F(GridTrackerTest, SaysWhatEachStageFound) {
  const Pose2 place{-1.3, -1.05, 0.3};
  for (const bool second : {false, true}) {
    p.use_second_stage_matcher = second;
    GridScanTracker tracker(p);
    tracker.reset({});
    tracker.track(seen(place), 0.0, {}, {});
    const TrackedScan tracked = tracker.track(seen(place), 0.1, {}, {});
    EXPECT_EQ(tracked.first_stage.has_value(), second);
    EXPECT_GT(tracked.covariance(0, 0), 0.0);
    EXPECT_GT(tracked.inlier_ratio, 0.9);
  }
}

TEST_F(GridTrackerTest, SaysWhetherADirectionIsOpen) {
  const auto corridor = [](int half_length) {
    frsm::Points points;
    for (int k = -half_length; k <= half_length; ++k) {
      for (const double wall : {-1.0, 1.0}) points.push_back({0.01 * k, wall});
    }
    return points;
  };
  const auto is_open = [&](const frsm::Points& first, const frsm::Points& second) {
    GridScanTracker tracker(p);
    tracker.track(first, 0.0, {}, {});
    return tracker.track(second, 0.1, {}, {}).degenerate;
  };
  EXPECT_TRUE(is_open(corridor(300), corridor(200)));
  EXPECT_FALSE(is_open(corridor(300), corridor(300))) << "its ends are seen";
  EXPECT_FALSE(is_open(seen({-1.3, -1.05, 0.3}), seen({-1.3, -1.05, 0.3})));
}

TEST_F(GridTrackerTest, DoesNotContradictOdometry) {
  const frsm::Points points = seen({-1.3, -1.05, 0.3});
  for (const char* const matcher : {"frsm_matcher", "cartographer_matcher"}) {
    builder.scanmatcher = matcher;
    IncrementalGraphBuilder incremental(parameters);
    incremental.begin({});
    incremental.track(points, 0.0, {});
    const TrackedScan tracked = incremental.track(points, 0.1, {});
    EXPECT_TRUE(incremental.is_placed(tracked)) << matcher;
    EXPECT_GT(tracked.extent, 0.5);
    EXPECT_EQ(incremental.make_edge({}, {0.4, 0.0, 0.0}, tracked, false).contradicts_odometry,
              builder.scanmatcher == "frsm_matcher");
  }
}

TEST_F(GridTrackerTest, BeginsAnewWhereNothingFits) {
  p.min_sm_accept_score = 0.45;
  GridScanTracker tracker(p);
  for (int k = 0; k < 5; ++k) tracker.track(seen({-1.3, -1.05, 0.0}), 0.0, {}, {});
  const Pose2 expected = tracker.track(seen({-1.3, -1.05, 0.0}), 0.0, {}, {}).T_local_sensor;
  const frsm::Points clutter{{1.0, 0.0}, {0.0, 1.3}, {-1.1, 0.4}, {0.3, -0.9}, {0.7, 0.7}};
  TrackedScan tracked;
  int unusable = 0;
  while (!tracked.restarted && unusable < 20) {
    tracked = tracker.track(clutter, 0.0, {}, {});
    EXPECT_FALSE(tracked.usable());
    ++unusable;
  }
  EXPECT_EQ(unusable, 5);
  EXPECT_LT(between(expected, tracked.T_local_sensor).translation().norm(), 1.0);
  EXPECT_TRUE(tracker.track(clutter, 0.0, {}, {}).usable()) << "on the new map it fits itself";
}

TEST_F(GridTrackerTest, WhatIsOverruledJoinsNoMap) {
  p.key_scan_distance = p.key_scan_angle = 0.0;
  GridScanTracker tracker(p);
  const Pose2 place{-1.3, -1.05, 0.3};
  tracker.reset({});
  tracker.track(seen(place), 0.0, {}, {});
  tracker.set_pose({0.5, 0.0, 0.0});  // the first one does, where it is said to be
  TrackedScan tracked = tracker.track(seen(place), 0.1, {}, {});
  EXPECT_NEAR(tracked.T_local_sensor.x, 0.5, 0.02);
  EXPECT_EQ(tracker.local_map().scans(), 1);
  tracker.set_pose({0.9, 0.0, 0.0});
  tracker.track(seen(place), 0.2, {-0.4, 0.0, 0.0}, {});
  EXPECT_EQ(tracker.local_map().scans(), 1);
  tracker.track(seen(place), 0.3, {}, {});
  EXPECT_EQ(tracker.local_map().scans(), 2);
}

TEST_F(GridTrackerTest, AParkedRobotAddsNoScans) {
  GridScanTracker tracker(p);
  tracker.reset({});
  for (int k = 0; k < 10; ++k) tracker.track(seen({-1.3, -1.05, 0.3}), 0.1 * k, {}, {});
  EXPECT_EQ(tracker.local_map().scans(), 1);
}

TEST(LocalGrids, HoldBetweenHalfAHistoryAndAWholeOne) {
  for (const int history : {2, 3, 10, 30}) {
    LocalGrids grids({kGrid}, history);
    const Points wall{{1.0, -0.5}, {1.0, 0.0}, {1.0, 0.5}};
    // Of the scan k, whose walls are a quarter of a metre beyond those of the one before: whether it is in the grid.
    const auto holds = [&](int k) {
      const GridLimits& limits = grids.grid(0).limits();
      const Eigen::Array2i cell = limits.to_cells({1.0 + 0.25 * k, 0.0}).array().round().cast<int>();
      double most = 0.0;  // points on the border between cells may be in either
      for (int dx = -1; dx <= 0; ++dx) {
        for (int dy = -1; dy <= 0; ++dy) most = std::max(most, grids.grid(0).probability(cell.x() + dx, cell.y() + dy));
      }
      return most > 0.5;
    };
    EXPECT_TRUE(grids.empty());
    for (int k = 0; k < 4 * history; ++k) {
      grids.insert(wall, {0.25 * k, 0.0, 0.0});
      EXPECT_LE(grids.scans(), history);
      EXPECT_GE(grids.scans(), std::min(k + 1, history / 2));
      for (int other = 0; other <= k; ++other)
        EXPECT_EQ(holds(other), other > k - grids.scans()) << other << " of " << k;
    }
    grids.clear();
    EXPECT_TRUE(grids.empty());
  }
}

/// The gates: odometry minus match for x, unlike FRSM's.
class GatesTest : public GridTrackerTest {
 protected:
  Rejection verdict(const Pose2& T_odometry_match, double hits = 0.8) const {
    TrackedScan node;
    node.rejection = Rejection::kNone;
    node.T_local_sensor = T_odometry_match;
    node.inlier_ratio = hits;
    return match_rejection(builder, node, {}, {});
  }
};

TEST_F(GatesTest, DocumentedOnesOfTheFirstStage) {
  p = testing::documented_parameters().incremental_graph_builder.cartographer_matcher;
  EXPECT_EQ(verdict({0.04, 0.02, 0.09}), Rejection::kNone);
  EXPECT_EQ(verdict({-0.051, 0.0, 0.0}), Rejection::kX) << "odometry is 5.1 cm ahead of the match";
  EXPECT_EQ(verdict({0.051, 0.0, 0.0}), Rejection::kDistance) << "the match is ahead: only the distance is too large";
  p.sm_dist_accept_threshold = 1.0;
  EXPECT_EQ(verdict({0.119, 0.0, 0.0}), Rejection::kNone);
  EXPECT_EQ(verdict({0.121, 0.0, 0.0}), Rejection::kX);
  EXPECT_EQ(verdict({-0.049, 0.0, 0.0}), Rejection::kNone);
  EXPECT_EQ(verdict({0.0, 0.109, 0.0}), Rejection::kNone);
  EXPECT_EQ(verdict({0.0, -0.111, 0.0}), Rejection::kY);
  EXPECT_EQ(verdict({0.0, 0.0, -0.101}), Rejection::kTheta);
  p.min_sm_accept_score = 0.5;
  EXPECT_EQ(verdict({}, 0.49), Rejection::kScore);
}

TEST_F(GatesTest, TheSecondStageHasItsOwn) {
  p = testing::documented_parameters().incremental_graph_builder.cartographer_matcher;
  TrackedScan node;
  node.rejection = Rejection::kNone;
  node.inlier_ratio = 0.7;
  node.first_stage = CoarseMatch{{0.03, 0.0, 0.0}, 0.8};
  const auto verdict = [&](const Pose2& T_odometry_match) {
    node.T_local_sensor = T_odometry_match;
    return match_rejection(builder, node, {}, {});
  };
  EXPECT_EQ(verdict({0.05, 0.0, 0.06}), Rejection::kNone);
  EXPECT_EQ(verdict({0.052, 0.0, 0.0}), Rejection::kSecondStageDistance);
  EXPECT_EQ(verdict({0.0, 0.0, 0.071}), Rejection::kSecondStageTheta);
  p.second_stage_matcher.min_sm_accept_score = 0.75;
  EXPECT_EQ(verdict({}), Rejection::kSecondStageScore);
  node.first_stage->T_local_sensor.x = 0.06;
  EXPECT_EQ(verdict({}), Rejection::kDistance) << "the first stage's come first";
  node.rejection = Rejection::kLowScore;
  EXPECT_EQ(verdict({}), Rejection::kLowScore);
}

}  // namespace
}  // namespace oort
