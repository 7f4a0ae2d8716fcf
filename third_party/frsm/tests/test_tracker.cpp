// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "drives.hpp"
#include "frsm/tracker.hpp"

namespace frsm {
namespace {

using test::drive;
using test::kPi;
using test::kSensor;
using test::oval;
using test::Sensor;
using test::standing_scan;
using test::Step;
using test::turn;

TEST(Tracker, FollowsADriveWithOdometry) {
  const auto steps = drive(test::room(), 200, 1);
  Tracker tracker;
  tracker.reset(oval(0));
  for (int i = 0; i < 200; ++i) {
    const Match match = tracker.track(steps[i].body, 0.1 * i, steps[i].odometry);
    EXPECT_EQ(match.status, i == 0 ? Status::kNoOverlap : Status::kOk) << i << to_string(match.status);
    EXPECT_EQ(tracker.matched(), i > 0);
    EXPECT_LT(distance(tracker.pose(), oval(i)), 0.03) << i;
    EXPECT_LT(turn(tracker.pose(), oval(i)), 0.015) << i;
  }
  EXPECT_EQ(tracker.restarts(), 0);
}

TEST(Tracker, FollowsADriveWithoutOdometry) {
  const auto steps = drive(test::room(), 200, 2);
  for (const bool stationary : {false, true}) {
    TrackerParams params;
    params.stationary_motion_model = stationary;
    Tracker tracker(params);
    tracker.reset(oval(0));
    for (int i = 0; i < 200; ++i) {
      tracker.track(steps[i].body, 0.1 * i, std::nullopt);
      EXPECT_LT(distance(tracker.pose(), oval(i)), 0.03) << i;
    }
  }
}

// The widest window is that of a usual motion: odometry that is doubted may be off by more, as its covariance says.
TEST(Tracker, SearchesAsFarAsDoubtedOdometryMayBeOff) {
  TrackerParams params;
  params.max_search_range_xy = params.max_search_range_theta = 0.1;
  const auto steps = drive(test::room(), 20, 5);
  const Pose turned = oval(19) * Pose{0.02, 0.0, 0.35};
  std::mt19937 random(5);
  const Points body = scan(test::room(), turned, kSensor, random);
  const Motion stands{Pose{}, Eigen::Vector3d(0.01, 0.01, 0.0144).asDiagonal()};
  const Motion turns_back{Pose{0.02, 0.0, -0.1}, stands.covariance};
  for (const bool doubted : {false, true}) {
    Tracker tracker(params);
    tracker.reset(oval(0));
    for (int i = 0; i < 20; ++i) tracker.track(steps[i].body, 0.1 * i, steps[i].odometry);
    const Match match =
        tracker.track(body, 2.0, stands, doubted ? std::vector<Motion>{turns_back} : std::vector<Motion>{});
    EXPECT_EQ(turn(match.pose, turned) < 0.02 && distance(match.pose, turned) < 0.03, doubted);
  }
}

TEST(Tracker, AddsByTheRule) {
  TrackerParams params;
  params.add.key_distance = params.add.key_angle = std::numeric_limits<double>::infinity();
  Tracker tracker(params);
  const auto steps = drive(test::room(), 3, 4);
  tracker.track(steps[0].body, 0.0, std::nullopt);
  EXPECT_TRUE(tracker.table().empty());  // the first scan joins at the next call
  tracker.track(steps[0].body, 0.1, std::nullopt);
  EXPECT_EQ(tracker.added_scans(), 1);
  // Moved, but the hits are good: nothing joins.
  tracker.track(steps[1].body, 0.2, steps[1].odometry);
  tracker.track(steps[1].body, 0.3, std::nullopt);
  EXPECT_EQ(tracker.added_scans(), 1);
  // A fifth of the points off the map: joins once.
  Points changed = steps[2].body;
  for (int i = 0; i < 40; ++i) changed[i] = {0.5 * changed[i].x, 0.5 * changed[i].y};
  const Match match = tracker.track(changed, 0.4, steps[2].odometry);
  EXPECT_LT(match.inlier_ratio, 0.9);
  EXPECT_TRUE(match.usable());
  const int before = tracker.num_scans();
  tracker.track(steps[2].body, 0.5, std::nullopt);
  EXPECT_EQ(tracker.num_scans(), before + 1);
  EXPECT_EQ(tracker.added_scans(), 2);
}

TEST(Tracker, KeyScansJoinByMotion) {
  const auto steps = drive(test::room(), 100, 5);
  TrackerParams params;
  params.add.hit_threshold = 0.0;
  params.add.key_distance = 0.2;
  params.add.key_angle = 10.0;
  Tracker tracker(params);
  tracker.reset(oval(0));
  double driven = 0.0;
  for (int i = 0; i < 100; ++i) {
    tracker.track(steps[i].body, 0.1 * i, steps[i].odometry);
    driven += distance(oval(std::max(0, i - 1)), oval(i));
  }
  EXPECT_NEAR(static_cast<double>(tracker.added_scans()), driven / 0.25, 0.25 * driven / 0.25);
}

TEST(Tracker, OriginalsRuleAddsWheneverHitsAreFew) {
  TrackerParams params;
  params.add = AddRule::by_hits(0.95);
  Tracker tracker(params);
  const Points body = standing_scan(6);
  Points changed = body;
  for (int i = 0; i < 30; ++i) changed[i] = {0.5 * changed[i].x, 0.5 * changed[i].y};
  tracker.track(body, 0.0, std::nullopt);
  tracker.track(changed, 0.1, std::nullopt);
  tracker.track(body, 0.2, std::nullopt);
  EXPECT_EQ(tracker.added_scans(), 2);  // although the robot stood still
}

TEST(Tracker, ParkedRobotAddsNothing) {
  Tracker tracker;
  tracker.reset(oval(0));
  std::mt19937 random(7);
  for (int i = 0; i < 300; ++i) {
    Points body = standing_scan(i);
    // People pass: a third of the view changes from scan to scan.
    const int first = std::uniform_int_distribution<int>(0, 120)(random);
    for (int k = first; k < first + (i > 0 ? 60 : 0); ++k) body[k] = {0.6 * body[k].x, 0.6 * body[k].y};
    tracker.track(body, 0.1 * i, Motion{});
  }
  EXPECT_EQ(tracker.added_scans(), 1);
  EXPECT_LT(distance(tracker.pose(), oval(0)), 0.02);
}

TEST(Tracker, OverruledScanDoesNotJoin) {
  TrackerParams params;
  params.add.key_distance = 0.0;
  params.add.min_distance = 0.0;  // every scan would join
  Tracker tracker(params);
  const Points body = standing_scan(8);
  tracker.track(body, 0.0, std::nullopt);
  tracker.set_pose({1.0, 2.0, 0.5});  // the first scan moves along: it is the map
  tracker.track(body, 0.1, Motion{});
  EXPECT_LT(distance(tracker.pose(), {1.0, 2.0, 0.5}), 5e-3);
  EXPECT_EQ(tracker.added_scans(), 1);
  tracker.set_pose({1.01, 2.0, 0.5});
  EXPECT_EQ(tracker.pose().x, 1.01);
  tracker.track(body, 0.2, Motion{});
  EXPECT_EQ(tracker.added_scans(), 1);
  tracker.track(body, 0.3, Motion{});
  EXPECT_EQ(tracker.added_scans(), 2);
}

// 16.6: the odometry stands still for a while, then makes up for it in one step.
TEST(Tracker, SurvivesOdometryThatFreezesAndJumps) {
  const auto steps = drive(test::room(), 120, 9);
  Tracker tracker;
  tracker.reset(oval(0));
  Pose held;
  for (int i = 0; i < 120; ++i) {
    Motion motion = steps[i].odometry;
    const bool frozen = i % 40 >= 20 && i % 40 < 26;
    held = held * motion.delta;
    motion.delta = frozen ? Pose{} : held;
    if (!frozen) held = Pose{};
    tracker.track(steps[i].body, 0.1 * i, motion);
    EXPECT_LT(distance(tracker.pose(), oval(i)), 0.05) << i;
    EXPECT_LT(turn(tracker.pose(), oval(i)), 0.03) << i;
  }
  EXPECT_GT(tracker.retries(), 0);
  EXPECT_EQ(tracker.restarts(), 0);
}

TEST(Tracker, StartsAfreshWhenNothingFits) {
  TrackerParams params;
  params.max_rejected_scans = 4;
  Tracker tracker(params);
  const Pose start{1.0, 0.0, 0.0};
  tracker.reset(start);
  tracker.track(standing_scan(10), 0.0, Motion{});
  tracker.track(standing_scan(11), 0.1, Motion{});
  // Carried to another place.
  std::mt19937 random(12);
  test::Scene elsewhere;
  test::add_box(&elsewhere, {0.4, 0.2, 0.3}, 1.1, 1.7);
  for (int i = 0; i < 6; ++i) {
    const Match match = tracker.track(test::scan(elsewhere, {}, kSensor, random), 0.2 + 0.1 * i, Motion{});
    if (i < 4) {
      EXPECT_FALSE(match.usable());
      EXPECT_FALSE(tracker.matched());
      EXPECT_LT(distance(match.pose, tracker.pose()), 1e-12);
    } else {
      EXPECT_TRUE(match.usable()) << to_string(match.status);
    }
  }
  EXPECT_EQ(tracker.restarts(), 1);
  EXPECT_LT(distance(tracker.pose(), start), 0.02);
}

TEST(Tracker, BlindMomentsAreBridgedByOdometry) {
  const auto steps = drive(test::room(), 60, 13);
  Tracker tracker;
  tracker.reset(oval(0));
  EXPECT_EQ(tracker.track({}, 0.0, Motion{}).status, Status::kEmptyScan);
  EXPECT_EQ(tracker.track({{1.0, 1.0}}, 0.0, Motion{}).status, Status::kTooFewPoints);
  EXPECT_EQ(tracker.num_scans(), 0);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 60; ++i) {
    const bool blind = i >= 20 && i < 32;
    const Match match = tracker.track(blind ? Points{{kNan, 1.0}} : steps[i].body, 0.1 * i, steps[i].odometry);
    if (blind) {
      EXPECT_EQ(match.status, Status::kEmptyScan);
    }
    EXPECT_LT(distance(tracker.pose(), oval(i)), 0.1) << i;
  }
  EXPECT_LT(distance(tracker.pose(), oval(59)), 0.03);
  EXPECT_EQ(tracker.restarts(), 0);
}

// A turn on the spot from one view into another that the local map does not show, with little to see in between.
TEST(Tracker, AFewHitsAfterAGapAreNotBelieved) {
  const test::Scene behind = {{{-2.0, -0.6}, {-2.0, 0.6}}};
  const Sensor sensor{181, kPi, 3.0, 0.005};
  std::mt19937 random(5);
  Tracker tracker;
  const test::Scene ahead = test::room();
  for (int i = 0; i < 5; ++i) {
    tracker.track(test::scan(ahead, {}, sensor, random), 0.1 * i, Motion{{}, Eigen::Matrix3d::Identity() * 1e-6});
  }
  ASSERT_TRUE(tracker.matched());
  const Motion turn{{0.0, 0.0, kPi / 2}, Eigen::Vector3d(1e-4, 1e-4, 0.01).asDiagonal()};
  tracker.track({}, 0.6, turn);
  const Points few = test::scan(behind, {0.0, 0.0, kPi}, {25, 0.6, 3.0, 0.005}, random);
  ASSERT_GE(few.size(), 10U);
  const Match match = tracker.track(few, 0.7, turn);
  EXPECT_TRUE(!tracker.matched() || match.inlier_ratio >= 0.8) << to_string(match.status) << " " << match.inlier_ratio;
}

TEST(Tracker, TwoRunsGiveTheSameBytes) {
  const auto steps = drive(test::room(), 120, 14);
  std::vector<Match> first;
  for (int run = 0; run < 2; ++run) {
    Tracker tracker;
    for (int i = 0; i < 120; ++i) {
      const Match match = tracker.track(steps[i].body, 0.1 * i, steps[i].odometry);
      if (run == 0) {
        first.push_back(match);
      } else {
        EXPECT_EQ(match.pose.x, first[i].pose.x);
        EXPECT_EQ(match.pose.y, first[i].pose.y);
        EXPECT_EQ(match.pose.theta, first[i].pose.theta);
        EXPECT_EQ(match.covariance, first[i].covariance);
      }
    }
  }
}

TEST(Tracker, ResetForgetsEverything) {
  const auto steps = drive(test::room(), 40, 15);
  Tracker tracker, fresh;
  for (int i = 0; i < 40; ++i) tracker.track(steps[i].body, 0.1 * i, steps[i].odometry);
  tracker.reset({3.0, 4.0, 1.0});
  fresh.reset({3.0, 4.0, 1.0});
  for (int i = 0; i < 40; ++i) {
    const Match match = tracker.track(steps[i].body, 0.1 * i, std::nullopt);
    EXPECT_EQ(match.pose.x, fresh.track(steps[i].body, 0.1 * i, std::nullopt).pose.x);
  }
}

TEST(Tracker, TrajectoryMovesWithItsStart) {
  const auto steps = drive(test::room(), 100, 16);
  for (const Pose& start : {Pose{100.3, -57.7, 1.0}, Pose{0.007, 0.013, -2.9}}) {
    Tracker reference, moved;
    moved.reset(start);
    for (int i = 0; i < 100; ++i) {
      reference.track(steps[i].body, 0.1 * i, steps[i].odometry);
      moved.track(steps[i].body, 0.1 * i, steps[i].odometry);
      const Pose expected = start * reference.pose();
      EXPECT_LT(distance(moved.pose(), expected), 0.02) << i;
      EXPECT_LT(turn(moved.pose(), expected), 0.01) << i;
    }
  }
}

// With an odometry 2 % too long, the estimate follows it.
TEST(Tracker, FollowsOdometryAlongACorridor) {
  std::mt19937 random(17);
  Tracker tracker;
  tracker.reset({-4.0, 0.0, 0.0});
  for (int i = 0; i <= 160; ++i) {
    Motion motion;
    motion.delta.x = i > 0 ? 0.05 * 1.02 : 0.0;
    motion.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
    const Pose truth{-4.0 + 0.05 * i, 0.0, 0.0};
    tracker.track(test::scan(test::corridor(), truth, {181, kPi, 6.0, 0.01}, random), 0.1 * i, motion);
  }
  EXPECT_NEAR(tracker.pose().x, -4.0 + 8.0 * 1.02, 8.0 * 0.01);
  EXPECT_NEAR(tracker.pose().y, 0.0, 0.05);
}

TEST(Tracker, RefusesInputThatMakesNoSense) {
  Tracker tracker;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Motion motion;
  motion.delta.x = kNan;
  EXPECT_THROW(tracker.track({}, 0.0, motion), std::invalid_argument);
  motion = {};
  motion.covariance(0, 0) = -1.0;
  EXPECT_THROW(tracker.track({}, 0.0, motion), std::invalid_argument);
  EXPECT_THROW(tracker.track({}, kNan, std::nullopt), std::invalid_argument);
  EXPECT_THROW(tracker.reset({kNan, 0.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(tracker.set_pose({0.0, 0.0, kNan}), std::invalid_argument);
  TrackerParams params;
  params.max_num_scans = 1;
  EXPECT_THROW(Tracker{params}, std::invalid_argument);
  params = {};
  params.initial_search_range_xy = 1.0;
  EXPECT_THROW(Tracker{params}, std::invalid_argument);
}

}  // namespace
}  // namespace frsm
