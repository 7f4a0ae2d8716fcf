// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/internal/graph_costs.hpp"

namespace oort {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Pose2 pose_of(const double* block) {
  return {block[0], block[1], block[2]};
}

void set(double** jacobians, int block, const Eigen::Matrix3d& jacobian) {
  if (jacobians == nullptr || jacobians[block] == nullptr) return;
  Eigen::Map<RowMajor3> out(jacobians[block]);
  out = jacobian;
}

}  // namespace

bool RelativePoseCost::Evaluate(double const* const* poses, double* residuals, double** jacobians) const {
  const Pose2 i = pose_of(poses[0]), j = pose_of(poses[1]);
  Eigen::Map<Eigen::Vector3d> error(residuals);
  error = W_ * constraint_error(i, j, T_i_j_);
  const ErrorJacobians of_error = constraint_jacobians(i, j);
  set(jacobians, 0, W_ * of_error.of_i);
  set(jacobians, 1, W_ * of_error.of_j);
  return true;
}

bool LandmarkCost::Evaluate(double const* const* poses, double* residuals, double** jacobians) const {
  const Pose2 sensor = interpolate(pose_of(poses[0]), pose_of(poses[1]), fraction_);
  const Pose2 landmark = pose_of(poses[2]);
  Eigen::Map<Eigen::Vector3d> error(residuals);
  error = W_ * constraint_error(sensor, landmark, T_sensor_landmark_);
  // Each number of the interpolated pose changes by a share of that of either node.
  const ErrorJacobians of_error = constraint_jacobians(sensor, landmark);
  set(jacobians, 0, (1.0 - fraction_) * (W_ * of_error.of_i));
  set(jacobians, 1, fraction_ * (W_ * of_error.of_i));
  set(jacobians, 2, W_ * of_error.of_j);
  return true;
}

}  // namespace oort
