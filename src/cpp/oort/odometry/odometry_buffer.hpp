// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <deque>
#include <optional>

#include "oort/geometry/pose2.hpp"

namespace oort {

/// Odometry poses by time, interpolated at a scan's stamp. The live node and offline replay share it, so that both see
/// the same odometry.
class OdometryBuffer {
 public:
  /// Poses older than `horizon` before the newest are dropped. [s]; 0 keeps all.
  explicit OdometryBuffer(double horizon = 0.0);

  /// Adds T_odom_base at a time [s]. Late messages find their place; one with a known time replaces the pose.
  /// Throws InputError if a value is not finite.
  void add(double time, const Pose2& T_odom_base);

  /// T_odom_base at a time [s], along a straight line between the two neighbours; nothing outside the times held, but
  /// for up to `most_ahead` [s] after the newest pose: there the base goes on as the last poses moved, along an arc.
  std::optional<Pose2> lookup(double time, double most_ahead = 0.0) const;

  void clear() { samples_.clear(); }
  std::size_t size() const { return samples_.size(); }

 private:
  struct Sample {
    double time;
    Pose2 pose;
  };
  std::optional<Pose2> extrapolate(double time) const;

  double horizon_;
  std::deque<Sample> samples_;  // by time
};

}  // namespace oort
