// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/geometry/pose2.hpp"

#include <cmath>

namespace oort {

double wrap_angle(double angle) {
  if (angle >= -M_PI && angle < M_PI) return angle;  // keeps the bits of an angle that is in range
  const double turns = std::floor((angle + M_PI) / (2.0 * M_PI));
  const double wrapped = angle - 2.0 * M_PI * turns;
  return wrapped >= M_PI ? wrapped - 2.0 * M_PI : wrapped;  // rounding may leave it at +pi exactly
}

Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  return {T_a_b.x + c * T_b_c.x - s * T_b_c.y, T_a_b.y + s * T_b_c.x + c * T_b_c.y,
          wrap_angle(T_a_b.theta + T_b_c.theta)};
}

Eigen::Vector2d operator*(const Pose2& T_a_b, const Eigen::Vector2d& p_b) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  return {T_a_b.x + c * p_b.x() - s * p_b.y(), T_a_b.y + s * p_b.x() + c * p_b.y()};
}

Pose2 inverse(const Pose2& T_a_b) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  return {-c * T_a_b.x - s * T_a_b.y, s * T_a_b.x - c * T_a_b.y, wrap_angle(-T_a_b.theta)};
}

Pose2 between(const Pose2& T_a_b, const Pose2& T_a_c) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  const double dx = T_a_c.x - T_a_b.x;
  const double dy = T_a_c.y - T_a_b.y;
  return {c * dx + s * dy, -s * dx + c * dy, wrap_angle(T_a_c.theta - T_a_b.theta)};
}

Pose2 interpolate(const Pose2& from, const Pose2& to, double fraction) {
  return {from.x + fraction * (to.x - from.x), from.y + fraction * (to.y - from.y),
          wrap_angle(from.theta + fraction * wrap_angle(to.theta - from.theta))};
}

Pose2 along_arc(const Pose2& T_a_b, double fraction) {
  const double half_turn = 0.5 * T_a_b.theta;
  // The chord of a part of an arc: how long it is, and how far it points away from the chord of the whole.
  const double length = std::abs(half_turn) < 1e-7 ? fraction : std::sin(fraction * half_turn) / std::sin(half_turn);
  const double c = length * std::cos((fraction - 1.0) * half_turn);
  const double s = length * std::sin((fraction - 1.0) * half_turn);
  return {c * T_a_b.x - s * T_a_b.y, s * T_a_b.x + c * T_a_b.y, wrap_angle(fraction * T_a_b.theta)};
}

bool is_finite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta);
}

Eigen::Matrix2d rotation(double theta) {
  const double c = std::cos(theta);
  const double s = std::sin(theta);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}

Eigen::Matrix3d rotate_covariance(const Eigen::Matrix3d& covariance, double theta) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = rotation(theta);
  return R * covariance * R.transpose();
}

Eigen::Matrix3d compound_covariance(const Pose2& T_a_b, const Eigen::Matrix3d& covariance_a_b, const Pose2& T_b_c,
                                    const Eigen::Matrix3d& covariance_b_c) {
  const Eigen::Vector2d lever = rotation(T_a_b.theta) * T_b_c.translation();
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J(0, 2) = -lever.y();
  J(1, 2) = lever.x();
  return J * covariance_a_b * J.transpose() + rotate_covariance(covariance_b_c, T_a_b.theta);
}

Eigen::Matrix3d inverse_covariance(const Pose2& T_a_b, const Eigen::Matrix3d& covariance_a_b) {
  const Pose2 T_b_a = inverse(T_a_b);
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();  // of inverse(): d(-R^T t)/dt = -R^T, d(-R^T t)/dtheta = (y_b_a, -x_b_a)
  J.topLeftCorner<2, 2>() = -rotation(-T_a_b.theta);
  J(0, 2) = T_b_a.y;
  J(1, 2) = -T_b_a.x;
  J(2, 2) = -1.0;
  return J * covariance_a_b * J.transpose();
}

}  // namespace oort
