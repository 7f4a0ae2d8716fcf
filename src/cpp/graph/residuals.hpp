// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
// The residuals of the pose graph. Internal to the optimiser: an embedder who includes this header needs Ceres.
#include <ceres/sized_cost_function.h>

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

/// r = W e (constraint_error, whitening_matrix), for a link that is always believed.
/// Parameters: pose i (x, y, theta), pose j (x, y, theta).
///
///   de/dpose_i = [ -R^T | dR^T/dtheta (p_j - p_i) ; 0 0 | -1 ],  de/dpose_j = [ R^T | 0 ; 0 0 | 1 ],  R = R(theta_i)
class ChainResidual final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  ChainResidual(const Pose2& T_i_j, const Eigen::Matrix3d& whitening_matrix);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  Pose2 T_i_j_;
  Eigen::Matrix3d W_;
};

/// r = s W e, for a link that may be switched off (Suenderhauf and Protzel 2012, "Switchable Constraints for Robust
/// Pose Graph SLAM", with Psi(s) = s: the information of the link becomes s^2 times its own).
/// Parameters: pose i, pose j, switch s. dr/dpose = s W de/dpose; dr/ds = W e.
class SwitchableResidual final : public ceres::SizedCostFunction<3, 3, 3, 1> {
 public:
  SwitchableResidual(const Pose2& T_i_j, const Eigen::Matrix3d& whitening_matrix);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  ChainResidual chain_;
};

/// r = sqrt(scale) (1 - s): the price of switching a link off (the switch prior of the same paper, with gamma = 1 and
/// variance 1 / scale). Parameter: switch s. dr/ds = -sqrt(scale).
///
/// With the poses held, 1/2 (s^2 chi^2 + scale (1 - s)^2) is least at s = scale / (scale + chi^2), which lies in
/// (0, 1]: the switch needs no bounds.
class SwitchPrior final : public ceres::SizedCostFunction<1, 1> {
 public:
  explicit SwitchPrior(double scale);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  double sqrt_scale_;
};

}  // namespace oort
