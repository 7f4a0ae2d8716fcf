// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// A robot whose place is not known any more finds home (docs/tracking.md).
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mapping_fixtures.hpp"
#include "oort/mapper/mapper.hpp"

namespace oort {
namespace {

using namespace testing;

double worst_error(const Mapper& mapper, const Pose2& T_world_sensor, const Pose2& T_world_map) {
  const Pose2 error = between(T_world_sensor, T_world_map * mapper.sensor_pose());
  return std::max(error.translation().norm(), std::abs(error.theta));
}

/// Two laps, then `interrupted`, then another lap that begins half way round while odometry goes on as if nothing had
/// happened. Returns how far off the sensor is after so many metres of it.
template <class Interruption>
double error_after(double metres, const Interruption& interrupted, bool threaded = true) {
  const World world = make_room();
  Parameters parameters = documented_parameters();
  parameters.global_slam_thread = threaded;
  Mapper mapper(parameters, kMount);
  const std::vector<Pose2> whole = laps(3.0);
  const std::size_t lap = whole.size() / 3;
  const std::vector<Pose2> before(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(2 * lap));
  drive(mapper, world, before, odometry_of(before, 0.01, 0.01));
  interrupted(mapper);
  const auto begin = whole.begin() + static_cast<std::ptrdiff_t>(lap + lap / 2);
  const std::vector<Pose2> after(begin, begin + static_cast<std::ptrdiff_t>(metres / 0.04));
  drive(mapper, world, after, odometry_of(after, 0.01, 0.01, 2), 1000.0);
  return worst_error(mapper, after.back() * kMount, before.front() * kMount);
}

TEST(SegmentSearchTest, ARobotCarriedWhilePausedIsHomeWithinMetres) {
  EXPECT_LT(error_after(6.0, [](Mapper& mapper) { mapper.resume_from_paused(); }), 0.1);
}

TEST(SegmentSearchTest, ASessionAtAWrongPoseIsHomeWithinMetres) {
  EXPECT_LT(error_after(6.0, [](Mapper& mapper) { mapper.begin_session({4.0, -3.0, 3.0}); }), 0.1);
}

TEST(SegmentSearchTest, FindsTheSamePlaceWithoutTheThread) {
  const auto pause = [](Mapper& mapper) { mapper.resume_from_paused(); };
  EXPECT_EQ(error_after(6.0, pause, true), error_after(6.0, pause, false));
}

}  // namespace
}  // namespace oort
