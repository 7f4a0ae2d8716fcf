// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "frsm/tracker.hpp"
#include "frsm/view.hpp"
#include "scene.hpp"

namespace frsm {
namespace {

using test::kPi;
using test::Scene;
using test::Sensor;

TEST(View, CoversWhatLiesUpToItsReturns) {
  std::mt19937 random(1);
  const Pose origin{1.0, 2.0, 0.5 * kPi};  // looks along y
  const Scene wall{{{-4.0, 5.0}, {6.0, 5.0}}};
  const View view(test::scan(wall, origin, {181, kPi, 8.0, 0.0}, random), origin);
  EXPECT_TRUE(view.covers({1.0, 4.0})) << "free floor";
  EXPECT_TRUE(view.covers({2.0, 5.05})) << "the wall, a little off";
  EXPECT_FALSE(view.covers({1.0, 6.0})) << "behind the wall";
  EXPECT_FALSE(view.covers({1.0, 1.0})) << "behind the sensor";
  EXPECT_FALSE(view.covers({8.5, 2.2})) << "where no beam returned";
}

TEST(View, OfNothingCoversNothing) {
  EXPECT_FALSE(View({}, {}).covers({0.5, 0.0}));
}

/// A corridor with niches that ends in a hall: who backs out of it, a metre from scan to scan, sees mostly new walls.
TEST(Tracker, ScansThatSeeMostlyNewWallsAreJudgedByTheOldOnes) {
  Scene scene{{{0.0, 0.6}, {6.0, 0.6}},
              {{6.0, -0.6}, {0.0, -0.6}},
              {{6.0, 0.6}, {6.0, -0.6}},
              {{0.0, -0.6}, {0.0, -4.0}},
              {{0.0, 4.0}, {0.0, 0.6}}};
  test::add_box(&scene, {4.0, 0.5, 0.0}, 0.4, 0.4);
  test::add_box(&scene, {2.0, -0.5, 0.0}, 0.4, 0.3);
  const Sensor sensor{181, kPi, 8.0, 0.01};
  std::mt19937 random(2);
  TrackerParams params;
  params.max_search_range_xy = params.max_search_range_theta = 0.3;
  Tracker tracker(params);
  Pose truth{3.0, 0.0, 0.0};
  tracker.reset(truth);
  const Motion back{{-1.05, 0.02, 0.01}, Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal()};
  for (int k = 0; k < 6; ++k) {
    if (k > 0) truth = truth * Pose{-1.0, 0.0, 0.0};
    tracker.track(test::scan(scene, truth, sensor, random), k, k > 0 ? back : Motion{});
    EXPECT_EQ(tracker.matched(), k > 0) << k;
    EXPECT_LT(distance(tracker.pose(), truth), 0.05) << k;
  }
  EXPECT_EQ(tracker.restarts(), 0);
}

/// Encoders that count the turns of wheels without their sense.
TEST(Tracker, TheWayBackwardsIsTriedWhereTheScanDoesNotFitAhead) {
  const Sensor sensor{181, kPi, 8.0, 0.01};
  for (const double direction : {1.0, -1.0}) {
    std::mt19937 random(3);
    Tracker tracker;
    const Pose start{0.2, 0.3, 0.2};
    tracker.reset(start);
    tracker.track(test::scan(test::room(), start, sensor, random), 0.0, Motion{});
    const Eigen::Matrix3d covariance = Eigen::Vector3d(0.005, 0.005, 0.01).asDiagonal();
    const Motion ahead{{0.7, 0.0, 0.1}, covariance};
    const Motion reversed{{-0.7, 0.0, 0.1}, covariance, true};
    const Pose truth = start * Pose{direction * 0.7, 0.0, 0.1};
    tracker.track(test::scan(test::room(), truth, sensor, random), 1.0, ahead, {reversed});
    EXPECT_EQ(tracker.hypothesis(), direction > 0.0 ? 0u : 1u);
    EXPECT_LT(distance(tracker.pose(), truth), 0.03);
  }
}

}  // namespace
}  // namespace frsm
