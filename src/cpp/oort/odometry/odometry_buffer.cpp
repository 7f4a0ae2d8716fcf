// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/odometry/odometry_buffer.hpp"

#include <algorithm>
#include <cmath>

#include "oort/geometry/errors.hpp"
#include "oort/odometry/tuning.hpp"

namespace oort {

OdometryBuffer::OdometryBuffer(double horizon) : horizon_(horizon) {}

void OdometryBuffer::add(double time, const Pose2& T_odom_base) {
  if (!std::isfinite(time) || !is_finite(T_odom_base)) {
    throw InputError("odometry: a time or pose is not a finite number; check what publishes odom -> base");
  }
  auto place = samples_.end();
  while (place != samples_.begin() && std::prev(place)->time >= time) --place;
  if (place != samples_.end() && place->time == time) {
    place->pose = T_odom_base;
  } else {
    samples_.insert(place, {time, T_odom_base});
  }
  if (horizon_ > 0.0) {
    while (samples_.front().time < samples_.back().time - horizon_) samples_.pop_front();
  }
}

std::optional<Pose2> OdometryBuffer::lookup(double time, double most_ahead) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), time,
                                      [](const Sample& sample, double t) { return sample.time < t; });
  if (after == samples_.end()) {
    const bool is_near = !samples_.empty() && time - samples_.back().time <= most_ahead;
    return is_near ? extrapolate(time) : std::nullopt;
  }
  if (after->time == time) return after->pose;
  if (after == samples_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  return interpolate(before->pose, after->pose, (time - before->time) / (after->time - before->time));
}

std::optional<Pose2> OdometryBuffer::extrapolate(double time) const {
  const Sample& newest = samples_.back();
  for (auto sample = std::next(samples_.rbegin()); sample != samples_.rend(); ++sample) {
    const double span = newest.time - sample->time;
    if (span > OdometryTuning::kMaxSpan) break;
    if (span < OdometryTuning::kMinSpan) continue;
    return newest.pose * along_arc(between(sample->pose, newest.pose), (time - newest.time) / span);
  }
  return std::nullopt;
}

}  // namespace oort
