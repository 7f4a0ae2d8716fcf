// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "frsm/velocity.hpp"

#include <algorithm>

namespace frsm {
namespace {

constexpr std::size_t kPoses = 5;
constexpr double kLongest = 2.0;  // intervals, for one prediction

}  // namespace

void Velocity::add(const Pose& pose, double time) {
  states_.push_back({pose, time});
  if (states_.size() > kPoses) states_.pop_front();
}

void Velocity::replace_last(const Pose& pose) {
  if (!states_.empty()) states_.back().pose = pose;
}

Pose Velocity::motion_until(double time) const {
  if (states_.size() < 2) return {};
  const auto intervals = static_cast<double>(states_.size() - 1);
  const double interval = (states_.back().time - states_.front().time) / intervals;
  Pose mean;  // motion in one interval, in the body's frame
  for (std::size_t i = 1; i < states_.size(); ++i) {
    const Pose step = between(states_[i - 1].pose, states_[i].pose);
    mean.x += step.x / intervals;
    mean.y += step.y / intervals;
    mean.theta += step.theta / intervals;
  }
  double ratio = 1.0;  // when the times do not tell
  if (interval > 0.0 && time > states_.back().time) {
    ratio = std::min((time - states_.back().time) / interval, kLongest);
  }
  return {mean.x * ratio, mean.y * ratio, wrap(mean.theta * ratio)};
}

}  // namespace frsm
