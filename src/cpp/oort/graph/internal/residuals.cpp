// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/internal/residuals.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

// How far a covariance may be from symmetric, relative to its largest entry: what products such as R S R^T leave
// behind is some 1e-16; anything near this bound is a mistake of the caller.
constexpr double kSymmetryTolerance = 1e-9;

}  // namespace

Eigen::Vector3d constraint_error(const Pose2& T_map_i, const Pose2& T_map_j, const Pose2& T_i_j) {
  const double c = std::cos(T_map_i.theta);
  const double s = std::sin(T_map_i.theta);
  const double dx = T_map_j.x - T_map_i.x;
  const double dy = T_map_j.y - T_map_i.y;
  return {c * dx + s * dy - T_i_j.x, -s * dx + c * dy - T_i_j.y,
          wrap_angle(T_map_j.theta - T_map_i.theta - T_i_j.theta)};
}

Eigen::Matrix3d whitening_matrix(const Eigen::Matrix3d& covariance, Whitening whitening) {
  if (!covariance.allFinite()) throw InputError("covariance is not finite");
  const double asymmetry = (covariance - covariance.transpose()).cwiseAbs().maxCoeff();
  if (asymmetry > kSymmetryTolerance * covariance.cwiseAbs().maxCoeff()) {
    throw InputError("covariance is not symmetric");
  }
  const Eigen::Matrix3d symmetric = 0.5 * (covariance + covariance.transpose());
  const Eigen::LLT<Eigen::Matrix3d> cholesky(symmetric);
  if (cholesky.info() != Eigen::Success) throw InputError("covariance is not positive definite");
  const Eigen::LLT<Eigen::Matrix3d> information(cholesky.solve(Eigen::Matrix3d::Identity()));
  const Eigen::Matrix3d L = information.matrixL();
  if (information.info() != Eigen::Success || !L.allFinite()) throw InputError("covariance is close to singular");
  return whitening == Whitening::kCorrect ? Eigen::Matrix3d(L.transpose()) : L;
}

ErrorJacobians constraint_jacobians(const Pose2& T_map_i, const Pose2& T_map_j) {
  const double c = std::cos(T_map_i.theta);
  const double s = std::sin(T_map_i.theta);
  const double dx = T_map_j.x - T_map_i.x;
  const double dy = T_map_j.y - T_map_i.y;
  ErrorJacobians result;
  result.of_i << -c, -s, -s * dx + c * dy,  //
      s, -c, -c * dx - s * dy,              //
      0.0, 0.0, -1.0;
  result.of_j << c, s, 0.0,  //
      -s, c, 0.0,            //
      0.0, 0.0, 1.0;
  return result;
}

}  // namespace oort
