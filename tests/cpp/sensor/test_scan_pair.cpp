// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "mapping_fixtures.hpp"
#include "oort/sensor/scan_pair.hpp"

namespace oort {
namespace {

using testing::kPi;
using testing::World;

const testing::Sensor kHallLaser{181, kPi, 20.0};

void add_box(World& world, double x, double y, double length, double width) {
  testing::add_outline({{x, y}, {x + length, y}, {x + length, y + width}, {x, y + width}}, world);
}

/// 40 m by 24 m with racks: most returns are so far away that beams of 1 degree are farther apart than 0.1 m.
World make_hall() {
  World world;
  add_box(world, -15.0, -12.0, 40.0, 24.0);
  add_box(world, 4.0, -5.0, 9.0, 1.2);
  add_box(world, 6.0, 5.0, 7.0, 1.2);
  return world;
}

/// Trunks, each of a return or a few.
World make_forest() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-12.0, 12.0);
  World world;
  for (int k = 0; k < 60; ++k) {
    const double x = place(random);
    const double y = place(random);
    if (std::hypot(x, y) > 1.5) add_box(world, x, y, 0.35, 0.35);
  }
  return world;
}

LaserScan seen(const World& world, const Pose2& pose, unsigned seed, const testing::Sensor& sensor = kHallLaser) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.01);
  LaserScan scan = see(world, pose, 0.0, sensor);
  for (float& range : scan.ranges) range += static_cast<float>(noise(random));
  return scan;
}

PairMatch best(const LaserScan& before, const LaserScan& after, const std::vector<Pose2>& guesses) {
  return ReferenceScan(to_point_cloud(before)).align_best(to_point_cloud(after), guesses, SensorTuning::kPointsOfPairs);
}

void expect_near(const Pose2& found, const Pose2& truth) {
  EXPECT_NEAR(found.x, truth.x, 0.06);  // far walls, few points
  EXPECT_NEAR(found.y, truth.y, 0.06);
  EXPECT_NEAR(found.theta, truth.theta, 0.01);
}

TEST(ScanPair, InAHallAndAForestMostPointsHavePartners) {
  for (const World& world : {make_hall(), make_forest()}) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      const Pose2 begin{0.2 * seed - 1.0, 0.1 * seed, 0.3 * seed};
      const Pose2 moved{0.15, 0.01, 0.05};
      const PairMatch match = best(seen(world, begin, seed), seen(world, begin * moved, 50 + seed), {{}, moved});
      expect_near(match.T_reference_scan, moved);
      EXPECT_GE(match.inlier_ratio, 0.7);
      EXPECT_LE(match.misfit, 0.04 * 0.04);  // trunks have edges
    }
  }
}

TEST(ScanPair, WhatIsNewInAScanLowersTheShareNotTheFit) {
  const World hall = make_hall();
  const Pose2 moved{0.1, 0.0, 0.02};
  const LaserScan before = seen(hall, {}, 1);
  LaserScan after = seen(hall, moved, 2);
  const PairMatch whole = best(before, after, {moved});
  std::fill(after.ranges.begin(), after.ranges.begin() + 40, 0.8F);  // somebody stands there
  const PairMatch part = best(before, after, {moved});
  EXPECT_LT(part.inlier_ratio, whole.inlier_ratio - 0.15);
  EXPECT_GT(part.cost, 2.0 * whole.cost);
  EXPECT_LT(part.misfit, 2.0 * whole.misfit);
  expect_near(part.T_reference_scan, moved);
}

TEST(ScanPair, TheBestOfTheGuessesCounts) {
  const World hall = make_hall();
  const Pose2 moved{0.3, 0.1, 0.3};
  const PairMatch match = best(seen(hall, {}, 1), seen(hall, moved, 2), {{-0.3, -0.1, -0.3}, {0.3, 0.1, 0.25}, {}});
  expect_near(match.T_reference_scan, moved);
}

// Surfaces are looked up by bearing, which tells nothing of those nearer than the reach.
TEST(ScanPair, WallsNearerThanTheReach) {
  World box;
  add_box(box, -0.25, -0.3, 0.6, 0.5);
  const Pose2 moved{0.05, 0.03, 0.1};
  const testing::Sensor around{360, 2.0 * kPi, 5.0};
  const auto scan = [&](const Pose2& pose) { return see(box, pose, 0.0, around); };
  const PairMatch match = best(scan({}), scan(moved), {{}});
  EXPECT_NEAR(match.T_reference_scan.x, moved.x, 0.01);
  EXPECT_NEAR(match.T_reference_scan.y, moved.y, 0.01);
  EXPECT_NEAR(match.T_reference_scan.theta, moved.theta, 0.02);
  EXPECT_GE(match.inlier_ratio, 0.95);
}

TEST(ScanPair, TooFewReturnsMatchNothing) {
  LaserScan few = see(make_hall(), {}, 0.0, kHallLaser);
  std::fill(few.ranges.begin() + 12, few.ranges.end(), std::numeric_limits<float>::infinity());
  const LaserScan whole = see(make_hall(), {}, 0.0, kHallLaser);
  EXPECT_EQ(best(whole, few, {{}}).inlier_ratio, 0.0);
  EXPECT_EQ(best(few, whole, {{}}).inlier_ratio, 0.0);
}

}  // namespace
}  // namespace oort
