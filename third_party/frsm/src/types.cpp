// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "frsm/types.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace frsm {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kReach = 1e5;  // [m]; keeps cell indices far from the limits of int

}  // namespace

double wrap(double angle) {
  const double wrapped = angle - 2.0 * kPi * std::floor((angle + kPi) / (2.0 * kPi));
  return wrapped < kPi ? wrapped : -kPi;  // rounding may land on +pi
}

Pose operator*(const Pose& T_a_b, const Pose& T_b_c) {
  const Point origin = T_a_b * Point{T_b_c.x, T_b_c.y};
  return {origin.x, origin.y, wrap(T_a_b.theta + T_b_c.theta)};
}

Point operator*(const Pose& T_a_b, const Point& p_b) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  return {T_a_b.x + c * p_b.x - s * p_b.y, T_a_b.y + s * p_b.x + c * p_b.y};
}

Pose between(const Pose& T_a_b, const Pose& T_a_c) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  const double dx = T_a_c.x - T_a_b.x;
  const double dy = T_a_c.y - T_a_b.y;
  return {c * dx + s * dy, -s * dx + c * dy, wrap(T_a_c.theta - T_a_b.theta)};
}

double distance(const Pose& a, const Pose& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

Points transform(const Pose& pose, const Points& points) {
  const double c = std::cos(pose.theta);
  const double s = std::sin(pose.theta);
  Points moved;
  moved.reserve(points.size());
  for (const Point& p : points) moved.push_back({pose.x + c * p.x - s * p.y, pose.y + s * p.x + c * p.y});
  return moved;
}

Eigen::Matrix3d rotate_covariance(const Eigen::Matrix3d& covariance, double theta) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(theta).toRotationMatrix();
  return R * covariance * R.transpose();
}

bool is_finite(const Pose& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta);
}

bool is_finite(const Point& point) {
  return std::isfinite(point.x) && std::isfinite(point.y);
}

Points drop_invalid(const Points& points) {
  Points valid;
  valid.reserve(points.size());
  std::copy_if(points.begin(), points.end(), std::back_inserter(valid),
               [](const Point& p) { return is_finite(p) && std::abs(p.x) < kReach && std::abs(p.y) < kReach; });
  return valid;
}

Points within(Points points, double radius) {
  const auto is_far = [&](const Point& p) { return std::hypot(p.x, p.y) > radius; };
  points.erase(std::remove_if(points.begin(), points.end(), is_far), points.end());
  return points;
}

}  // namespace frsm
