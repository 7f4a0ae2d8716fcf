// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
// Internal to the optimiser.
#include <Eigen/Core>

#include "oort/geometry/pose2.hpp"
#include "oort/graph/optimizer.hpp"

namespace oort {

/// e = [R(theta_i)^T (p_j - p_i) - z_xy ; wrap(theta_j - theta_i - z_theta)], with p the translations of the two
/// nodes and z the measured T_i_j: the error along the axes of node i, not log(z^-1 T).
/// [m, m, rad] (Grisetti et al. 2010, "A Tutorial on Graph-Based SLAM", eqs. 30-32, with R_z dropped.)
Eigen::Vector3d constraint_error(const Pose2& T_map_i, const Pose2& T_map_j, const Pose2& T_i_j);

/// The matrix W that makes |W e|^2 the squared Mahalanobis distance of e. With L L^T = covariance^-1 (L lower
/// triangular), e^T covariance^-1 e = |L^T e|^2, so W = L^T; kOriginal gives W = L.
/// A matrix that is symmetric up to rounding is symmetrised. InputError if it is not finite, not symmetric or not
/// positive definite.
Eigen::Matrix3d whitening_matrix(const Eigen::Matrix3d& covariance, Whitening whitening);

/// How constraint_error changes with the pose (x, y, theta) of either node.
///
///   de/dpose_i = [ -R^T | dR^T/dtheta (p_j - p_i) ; 0 0 | -1 ],  de/dpose_j = [ R^T | 0 ; 0 0 | 1 ],  R = R(theta_i)
struct ErrorJacobians {
  Eigen::Matrix3d of_i;
  Eigen::Matrix3d of_j;
};
ErrorJacobians constraint_jacobians(const Pose2& T_map_i, const Pose2& T_map_j);

}  // namespace oort
