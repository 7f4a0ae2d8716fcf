// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>

#include "frsm/types.hpp"

namespace frsm {

/// Constant velocity: where a body will be, from its last few poses. The twist is the body's own, so that a curve is
/// continued as a curve. Times may be bunched or step back, as those of logs do: the velocity is a mean over several
/// intervals, and no single interval counts as more than twice the mean.
class Velocity {
 public:
  /// The body's pose at a time [s]. Poses must belong to one unbroken motion: clear() after a jump.
  void add(const Pose& pose, double time);
  /// Corrects the last pose.
  void replace_last(const Pose& pose);
  void clear() { states_.clear(); }

  /// Expected motion, in the body's frame, from the last pose until a time. None before two poses are known.
  Pose motion_until(double time) const;

 private:
  struct State {
    Pose pose;
    double time;
  };
  std::deque<State> states_;
};

}  // namespace frsm
