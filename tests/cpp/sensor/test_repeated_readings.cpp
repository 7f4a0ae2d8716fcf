// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Scans that come again while the robot drives on.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "oort/sensor/laser.hpp"
#include "oort/sensor/repeated_readings.hpp"

namespace oort {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

LaserScan scan_of(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> range(1.0F, 4.0F);
  LaserScan scan{1.0, -1.0, 0.02, 0.1, 8.0, std::vector<float>(100)};
  for (float& each : scan.ranges) each = range(generator);
  scan.ranges[7] = kNan;
  return scan;
}

template <class Take>
void see_changes(const Take& take) {
  for (unsigned seed = 10; seed < 21; ++seed) take(scan_of(seed));
}

TEST(RepeatedReadings, OfALaserThatNeverChangesAreMadeUp) {
  RepeatedReadings repeated;
  for (int k = 0; k < 50; ++k) EXPECT_FALSE(repeated.add(scan_of(1).ranges, 99, {0.1 * k, 0.0, 0.0}));
}

TEST(RepeatedReadings, AreFoundOnceOdometryHasMoved) {
  RepeatedReadings repeated;
  see_changes([&](const LaserScan& scan) { repeated.add(scan.ranges, 99, {}); });
  const std::vector<float> first = scan_of(1).ranges, second = scan_of(2).ranges;
  EXPECT_FALSE(repeated.add(first, 99, {}));
  EXPECT_FALSE(repeated.add(first, 99, {0.003, 0.0, 0.003})) << "a robot that stands";
  EXPECT_TRUE(repeated.add(first, 99, {0.006, 0.0, 0.0}));
  EXPECT_TRUE(repeated.add(first, 99, {0.0, 0.0, -0.006}));
  EXPECT_FALSE(repeated.add(second, 99, {0.5, 0.0, 0.0}));
  EXPECT_FALSE(repeated.add(first, 99, {0.6, 0.0, 0.0}));
  std::vector<float> other = first;
  other.back() = std::nextafter(other.back(), 9.0F);
  EXPECT_FALSE(repeated.add(other, 99, {0.7, 0.0, 0.0}));
  EXPECT_EQ(repeated.count(), 2U);
}

TEST(RepeatedReadings, OfEmptySpaceSayNothing) {
  RepeatedReadings repeated;
  see_changes([&](const LaserScan& scan) { repeated.add(scan.ranges, 99, {}); });
  for (int k = 0; k < 5; ++k) EXPECT_FALSE(repeated.add(std::vector<float>(100, kNan), 0, {0.1 * k, 0.0, 0.0}));
}

TEST(RepeatedReadings, LeaveNothingOfAScan) {
  Laser laser(Parameters{}, {});
  see_changes([&](const LaserScan& scan) { laser.take(scan, {}, {}); });
  EXPECT_EQ(laser.take(scan_of(1), {}, {}).points.size(), 100U);
  const PointCloud again = laser.take(scan_of(1), {0.1, 0.0, 0.0}, {});
  EXPECT_TRUE(again.points.empty());
  EXPECT_EQ(again.time, 1.0);
  EXPECT_EQ(laser.take(scan_of(2), {0.2, 0.0, 0.0}, {}).points.size(), 100U);
  EXPECT_EQ(laser.findings().repeated_scans, 1U);
}

}  // namespace
}  // namespace oort
