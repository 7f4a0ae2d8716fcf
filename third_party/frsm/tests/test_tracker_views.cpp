// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// How far a tracker sees and searches: narrow views, and windows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "drives.hpp"
#include "frsm/tracker.hpp"

namespace frsm {
namespace {

using test::drive;
using test::kPi;
using test::oval;
using test::Sensor;
using test::turn;

/// Turns on the spot, less than once around, with odometry that is told to be worth little.
/// The sensor looks `mounted` away from the frame that its points are told in.
double missing_turn(double field_of_view, double mounted, unsigned seed) {
  constexpr double kStep = 0.08;
  constexpr int kSteps = 60;
  const Sensor sensor{static_cast<int>(field_of_view / kPi * 180.0), field_of_view, 3.0, 0.015};
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.01);
  Tracker tracker;
  const Pose place{1.2, 0.9, 0.0};
  tracker.reset(place);
  double turned = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const Points seen = test::scan(test::room(), {place.x, place.y, wrap(kStep * i)}, sensor, random);
    const Points body = transform({0.0, 0.0, mounted}, seen);
    const Motion odometry{{0.0, 0.0, i > 0 ? kStep + noise(random) : 0.0},
                          Eigen::Vector3d(1e-4, 1e-4, 1e-3).asDiagonal()};
    const double before = tracker.pose().theta;
    tracker.track(body, 0.1 * i, odometry);
    turned += wrap(tracker.pose().theta - before);
  }
  return (kSteps - 1) * kStep - turned;
}

TEST(Tracker, ANarrowViewTurnsAsFarAsAWideOne) {
  for (const double degrees : {60.0, 90.0, 180.0}) {
    for (const double mounted : {0.0, 2.9, kPi}) {
      double mean = 0.0;
      for (unsigned seed = 1; seed <= 16; ++seed) mean += missing_turn(degrees / 180.0 * kPi, mounted, seed) / 16.0;
      EXPECT_LT(std::abs(mean), 0.02) << degrees << " degrees, looking " << mounted << " rad to the left";
    }
  }
}

TEST(Tracker, SearchesNoFartherThanItMay) {
  for (const auto& [reach, is_found] : {std::pair{0.1, false}, std::pair{0.8, true}}) {
    TrackerParams params;
    params.max_search_range_xy = reach;
    params.max_search_range_theta = reach;
    Tracker tracker(params);
    std::mt19937 random(1);
    const Pose start{1.2, 0.9, 0.3}, end = start * Pose{0.05, 0.5, 0.5};
    tracker.reset(start);
    tracker.track(test::scan(test::room(), start, {}, random), 0.0, Motion{});
    const Motion unsure{{0.0, 0.0, 0.0}, Eigen::Vector3d(0.1, 0.1, 0.1).asDiagonal()};
    tracker.track(test::scan(test::room(), end, {}, random), 0.1, unsure);
    EXPECT_EQ(distance(tracker.pose(), end) < 0.05 && turn(tracker.pose(), end) < 0.05, is_found) << reach;
  }
}

// What comes into view stands 7 cm beside where the known walls would go on, near enough to be drawn to them: the match
// must not turn for it.
TEST(Tracker, WhatIsNewToAScanFarAwayDoesNotTurnIt) {
  const test::Scene scene = {{{-3.0, 1.5}, {3.7, 1.5}},    {{3.7, 1.57}, {9.0, 1.57}}, {{-3.0, -1.5}, {3.7, -1.5}},
                             {{3.7, -1.43}, {9.0, -1.43}}, {{1.6, 0.9}, {2.0, 0.9}},   {{2.6, -0.8}, {2.6, -0.5}}};
  const Pose end{1.2, 0.0, 0.0};
  double turned = 0.0;
  for (unsigned seed = 1; seed <= 16; ++seed) {
    std::mt19937 random(seed);
    Tracker tracker;
    tracker.track(test::scan(scene, {}, {181, kPi, 4.0, 0.01}, random), 0.0, Motion{});
    const Motion odometry{end, Eigen::Vector3d(2.5e-3, 2.5e-3, 2.5e-3).asDiagonal()};
    EXPECT_TRUE(tracker.track(test::scan(scene, end, {181, kPi, 4.0, 0.01}, random), 1.0, odometry).usable());
    EXPECT_LT(distance(tracker.pose(), end), 0.05);
    turned += tracker.pose().theta / 16.0;
  }
  EXPECT_LT(std::abs(turned), 0.001);  // [rad]; 0.0013 with all points
}

// Far along a wall the returns of coarse beams lie metres apart. Drawn as dots they fit each other best where the
// sensor has not moved.
TEST(Tracker, GoesOnInAHallThatCoarseBeamsSee) {
  test::Scene hall;
  test::add_box(&hall, {30.0, 18.0, 0.0}, 64.0, 44.0);
  for (int row = 0; row < 6; ++row) {
    for (int k = 0; k < 3; ++k) test::add_box(&hall, {10.0 + 19.0 * k, 3.0 + 6.0 * row, 0.0}, 15.0, 1.2);
  }
  TrackerParams params;
  params.contours = ContourParams::urg();
  params.contours.widest_beam_step = 0.08;
  Tracker tracker(params);
  std::mt19937 random(1);
  const Motion step{{0.14, 0.0, 0.0}, Eigen::Vector3d(2.5e-3, 2.5e-3, 1e-3).asDiagonal()};
  for (int i = 0; i < 40; ++i) {
    tracker.track(test::scan(hall, {0.14 * i, 0.0, 0.0}, {181, 1.5 * kPi, 20.0, 0.015}, random), 0.2 * i,
                  i > 0 ? step : Motion{});
  }
  EXPECT_LT(distance(tracker.pose(), {0.14 * 39, 0.0, 0.0}), 0.1);
}

// Half a coarse sensor's view, with stretches that see one wall only: far better than the odometry, which is 0.6 rad
// off.
TEST(Tracker, FollowsANarrowShortView) {
  constexpr int kDrives = 20;
  double mean_worst = 0.0, mean_worst_turn = 0.0;
  for (unsigned seed = 1; seed <= kDrives; ++seed) {
    const auto steps = drive(test::room(), 150, seed, {91, kPi / 2.0, 3.0, 0.01});
    Tracker tracker;
    tracker.reset(oval(0));
    Pose odometry = oval(0);
    double worst = 0.0, worst_turn = 0.0;
    for (int i = 0; i < 150; ++i) {
      tracker.track(steps[i].body, 0.1 * i, steps[i].odometry);
      odometry = odometry * steps[i].odometry.delta;
      worst = std::max(worst, distance(tracker.pose(), oval(i)));
      worst_turn = std::max(worst_turn, turn(tracker.pose(), oval(i)));
    }
    EXPECT_LT(worst, 0.4) << seed;
    EXPECT_LT(worst_turn, 0.2) << seed;
    EXPECT_GT(turn(odometry, oval(149)), 0.4) << seed;
    mean_worst += worst / kDrives;
    mean_worst_turn += worst_turn / kDrives;
  }
  EXPECT_LT(mean_worst, 0.16);
  EXPECT_LT(mean_worst_turn, 0.08);
}

}  // namespace
}  // namespace frsm
