// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <frsm/matcher.hpp>
#include <frsm/types.hpp>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/points.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/matching/rejection.hpp"

namespace oort {

inline frsm::Pose to_frsm(const Pose2& pose) {
  return {pose.x, pose.y, pose.theta};
}
inline Pose2 from_frsm(const frsm::Pose& pose) {
  return {pose.x, pose.y, wrap_angle(pose.theta)};
}

/// The verdict that a status is; kNone of kOk. A degenerate match may be used all the same (frsm::Match::usable).
Rejection rejection_of(frsm::Status status);

/// The returns of a cloud in beam order, in the sensor frame.
frsm::Points returns_of(const PointCloud& cloud);

/// The same points in the same order.
Points to_points(const frsm::Points& points);

/// Appends points, taken to another frame.
void append_transformed(const frsm::Points& points_b, const Pose2& T_a_b, frsm::Points& points_a);

}  // namespace oort
