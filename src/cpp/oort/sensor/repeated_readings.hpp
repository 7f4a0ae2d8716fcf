// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"

namespace oort {

/// Finds scans that hold the readings of the scan before, bit by bit, though the base has moved: a driver or a bridge
/// that sends its last buffer once more. They fit perfectly where the robot no longer is. The noise of a real laser
/// keeps the scans of two places, and most of one place, apart: it must have shown that, for what is made up
/// may be the same everywhere.
class RepeatedReadings {
 public:
  /// Takes a scan with its number of returns; the pose by odometry is the base's. Returns whether it is a repetition.
  bool add(const std::vector<float>& ranges, std::size_t returns, const Pose2& T_odom_base);

  std::uint64_t count() const { return count_; }

 private:
  std::vector<float> ranges_;
  Pose2 T_odom_base_;  // when these readings came first
  std::uint64_t changes_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace oort
