// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/sensor/repeated_readings.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "oort/sensor/tuning.hpp"

namespace oort {
namespace {

bool is_same(float a, float b) {
  return std::memcmp(&a, &b, sizeof a) == 0;  // nan, too
}

}  // namespace

bool RepeatedReadings::add(const std::vector<float>& ranges, std::size_t returns, const Pose2& T_odom_base) {
  if (!std::equal(ranges.begin(), ranges.end(), ranges_.begin(), ranges_.end(), is_same)) {
    if (!ranges_.empty()) ++changes_;
    ranges_ = ranges;
    T_odom_base_ = T_odom_base;
    return false;
  }
  if (changes_ < SensorTuning::kChangedReadings) return false;
  if (returns < SensorTuning::kRepeatedReturns) return false;  // no return anywhere looks the same everywhere
  const Pose2 moved = between(T_odom_base_, T_odom_base);
  if (moved.translation().norm() < SensorTuning::kRepeatedMotion &&
      std::abs(moved.theta) < SensorTuning::kRepeatedMotion) {
    return false;
  }
  ++count_;
  return true;
}

}  // namespace oort
