// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/residuals.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

// How far a covariance may be from symmetric, relative to its largest entry: what products such as R S R^T leave
// behind is some 1e-16; anything near this bound is a mistake of the caller.
constexpr double kSymmetryTolerance = 1e-9;

/// Ceres keeps Jacobians row by row.
void store(const Eigen::Matrix3d& jacobian, double* destination) {
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rows(destination);
  rows = jacobian;
}

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

ChainResidual::ChainResidual(const Pose2& T_i_j, const Eigen::Matrix3d& whitening_matrix)
    : T_i_j_(T_i_j), W_(whitening_matrix) {}

bool ChainResidual::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const double* const i = parameters[0];
  const double* const j = parameters[1];
  Eigen::Map<Eigen::Vector3d> r(residuals);
  r = W_ * constraint_error({i[0], i[1], i[2]}, {j[0], j[1], j[2]}, T_i_j_);
  if (!std::isfinite(r.squaredNorm())) return false;  // Ceres then tries a shorter step
  if (jacobians == nullptr) return true;

  const double c = std::cos(i[2]);
  const double s = std::sin(i[2]);
  const double dx = j[0] - i[0];
  const double dy = j[1] - i[1];
  if (jacobians[0] != nullptr) {
    Eigen::Matrix3d de_di;
    de_di << -c, -s, -s * dx + c * dy,  //
        s, -c, -c * dx - s * dy,        //
        0.0, 0.0, -1.0;
    store(W_ * de_di, jacobians[0]);
  }
  if (jacobians[1] != nullptr) {
    Eigen::Matrix3d de_dj;
    de_dj << c, s, 0.0,  //
        -s, c, 0.0,      //
        0.0, 0.0, 1.0;
    store(W_ * de_dj, jacobians[1]);
  }
  return true;
}

SwitchableResidual::SwitchableResidual(const Pose2& T_i_j, const Eigen::Matrix3d& whitening_matrix)
    : chain_(T_i_j, whitening_matrix) {}

bool SwitchableResidual::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  if (!chain_.Evaluate(parameters, residuals, jacobians)) return false;
  const double s = parameters[2][0];
  Eigen::Map<Eigen::Vector3d> r(residuals);
  if (jacobians != nullptr) {
    for (int pose = 0; pose < 2; ++pose) {
      if (jacobians[pose] != nullptr) Eigen::Map<Eigen::Matrix<double, 9, 1>>(jacobians[pose], 9) *= s;
    }
    if (jacobians[2] != nullptr) std::copy_n(residuals, 3, jacobians[2]);
  }
  r *= s;
  return true;
}

SwitchPrior::SwitchPrior(double scale) : sqrt_scale_(std::sqrt(scale)) {}

bool SwitchPrior::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  residuals[0] = sqrt_scale_ * (1.0 - parameters[0][0]);
  if (jacobians != nullptr && jacobians[0] != nullptr) jacobians[0][0] = -sqrt_scale_;
  return true;
}

}  // namespace oort
