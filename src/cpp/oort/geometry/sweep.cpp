// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/geometry/sweep.hpp"

#include <algorithm>
#include <cmath>

#include "oort/geometry/errors.hpp"
#include "oort/geometry/tuning.hpp"

namespace oort {
namespace {

bool is_too_much(const Pose2& motion) {
  return motion.translation().norm() > GeometryTuning::kMaxSweepTranslation ||
         std::abs(motion.theta) > GeometryTuning::kMaxSweepRotation;
}

bool is_nothing(const Pose2& motion) {
  return motion.x == 0.0 && motion.y == 0.0 && motion.theta == 0.0;
}

}  // namespace

bool is_snapshot(const Sweep& sweep) {
  if (is_nothing(sweep.T_stamp_first) && is_nothing(sweep.T_stamp_last)) return true;
  return is_too_much(sweep.T_stamp_first) || is_too_much(sweep.T_stamp_last) ||
         is_too_much(between(sweep.T_stamp_first, sweep.T_stamp_last));
}

Sweep sweep_of_sensor(const Sweep& sweep_of_base, const Pose2& T_base_sensor) {
  const Pose2 T_sensor_base = inverse(T_base_sensor);
  return {T_sensor_base * sweep_of_base.T_stamp_first * T_base_sensor,
          T_sensor_base * sweep_of_base.T_stamp_last * T_base_sensor};
}

PointCloud deskew(PointCloud cloud, const Sweep& sweep) {
  if (!is_finite(sweep.T_stamp_first) || !is_finite(sweep.T_stamp_last)) {
    throw InputError("scan: the motion while it was taken is not finite; check the transform odom -> base");
  }
  if (is_snapshot(sweep)) return cloud;
  const Pose2 motion = between(sweep.T_stamp_first, sweep.T_stamp_last);
  const double steps = std::max<double>(1.0, static_cast<double>(cloud.points.size()) - 1.0);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    Point2& point = cloud.points[i];
    const Pose2 T_stamp_beam = sweep.T_stamp_first * along_arc(motion, static_cast<double>(i) / steps);
    if (!std::isfinite(point.x)) {  // no reading: y is the bearing
      point.y += T_stamp_beam.theta;
      continue;
    }
    const Eigen::Vector2d moved = T_stamp_beam * Eigen::Vector2d(point.x, point.y);
    point.x = round_to_float32(moved.x());
    point.y = round_to_float32(moved.y());
  }
  return cloud;
}

}  // namespace oort
