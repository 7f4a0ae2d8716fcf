// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

namespace frsm {

/// A pose in the plane. As `T` it maps body points to the frame it is given in.
struct Pose {
  double x = 0.0;      ///< [m]
  double y = 0.0;      ///< [m]
  double theta = 0.0;  ///< [rad], in [-pi, pi) after any operation of this header
};

/// A point of a scan. [m]
struct Point {
  double x = 0.0;
  double y = 0.0;
};

/// Points of a scan in sensor order, that is by increasing bearing: contours rely on the neighbourhood of indices.
using Points = std::vector<Point>;

/// A motion between two scans, for instance from odometry.
struct Motion {
  Pose delta;                                            ///< current body pose seen from the previous body frame
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of delta (x, y, theta), axes of the previous body frame
  bool only_if_poor = false;  ///< as an alternative: tried only where the match with the odometry is poor
};

/// Wraps an angle to [-pi, pi). [rad]
double wrap(double angle);

/// T_a_c = T_a_b * T_b_c.
Pose operator*(const Pose& T_a_b, const Pose& T_b_c);

/// p_a = T_a_b * p_b.
Point operator*(const Pose& T_a_b, const Point& p_b);

/// T_b_c = inverse(T_a_b) * T_a_c.
Pose between(const Pose& T_a_b, const Pose& T_a_c);

/// Distance between the origins of two poses. [m]
double distance(const Pose& a, const Pose& b);

/// All points of a scan moved by a pose.
Points transform(const Pose& pose, const Points& points);

/// Turns a covariance (x, y, theta) along the axes of a frame at heading `theta` into the axes of its parent.
Eigen::Matrix3d rotate_covariance(const Eigen::Matrix3d& covariance, double theta);

bool is_finite(const Pose& pose);
bool is_finite(const Point& point);

/// The points whose coordinates are finite and within the lattice's reach (|x|, |y| < 1e5 m), in their order.
Points drop_invalid(const Points& points);

/// The points within a distance [m] of the origin, in their order: what a table does not draw, as it is too far away,
/// lies on nothing, and would only count as a miss.
Points within(Points points, double radius);

}  // namespace frsm
