// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapping/odometry_model.hpp"

#include <cmath>

namespace oort {
namespace {
double square(double value) {
  return value * value;
}
}  // namespace

Eigen::Matrix3d OdometryModel::covariance(const Pose2& T_before_after) const {
  const double way = T_before_after.translation().norm();
  const double turn = std::abs(T_before_after.theta);
  const double translation =
      square(translation_per_meter) * way + square(translation_per_radian) * turn + square(translation_floor);
  const double rotation =
      square(rotation_per_meter) * way + square(rotation_per_radian) * turn + square(rotation_floor);
  return Eigen::Vector3d(translation, translation, rotation).asDiagonal();
}

}  // namespace oort
