// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

namespace oort {

/// Wraps an angle to [-pi, pi). [rad]
double wrap_angle(double angle);

/// A rigid motion of the plane. `T_a_b` maps points of frame b to frame a: p_a = T_a_b * p_b.
struct Pose2 {
  double x = 0.0;      ///< [m]
  double y = 0.0;      ///< [m]
  double theta = 0.0;  ///< [rad], in [-pi, pi) after any operation of this header

  Eigen::Vector2d translation() const { return {x, y}; }
};

/// T_a_c = T_a_b * T_b_c.
Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c);

/// p_a = T_a_b * p_b.
Eigen::Vector2d operator*(const Pose2& T_a_b, const Eigen::Vector2d& p_b);

/// T_b_a from T_a_b.
Pose2 inverse(const Pose2& T_a_b);

/// T_b_c = inverse(T_a_b) * T_a_c.
Pose2 between(const Pose2& T_a_b, const Pose2& T_a_c);

/// The pose at a fraction of the motion from one to another, along a straight line with the shorter turn.
/// fraction 0 gives `from`, 1 gives `to`.
Pose2 interpolate(const Pose2& from, const Pose2& to, double fraction);

/// A part of the motion T_a_b that goes evenly along an arc (a constant twist: the exponential map of SE(2)).
/// fraction 0 gives no motion, 1 gives T_a_b, more goes on along the arc.
Pose2 along_arc(const Pose2& T_a_b, double fraction);

bool is_finite(const Pose2& pose);

/// Rotation matrix of an angle.
Eigen::Matrix2d rotation(double theta);

/// Turns a covariance (x, y, theta) given along the axes of a frame at heading `theta` into the axes of that
/// frame's parent: R S R^T with R = blockdiag(rotation(theta), 1).
Eigen::Matrix3d rotate_covariance(const Eigen::Matrix3d& covariance, double theta);

/// First-order covariance of T_a_c = T_a_b * T_b_c, where each covariance is of (x, y, theta) along the axes of the
/// first frame of its pose's name, and the two errors are independent (Smith, Self, Cheeseman 1990, compounding).
Eigen::Matrix3d compound_covariance(const Pose2& T_a_b, const Eigen::Matrix3d& covariance_a_b, const Pose2& T_b_c,
                                    const Eigen::Matrix3d& covariance_b_c);

/// First-order covariance of T_b_a = inverse(T_a_b), along the axes of frame b, from that of T_a_b along those of a.
Eigen::Matrix3d inverse_covariance(const Pose2& T_a_b, const Eigen::Matrix3d& covariance_a_b);

}  // namespace oort
