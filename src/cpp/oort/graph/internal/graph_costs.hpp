// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <ceres/sized_cost_function.h>

#include "oort/graph/internal/residuals.hpp"

/// The edges of a graph as cost functions for Ceres, of blocks x, y, theta, with analytic Jacobians. Internal: needs
/// Ceres' headers.
namespace oort {

/// W e of an edge, with e = constraint_error(pose_i, pose_j, T_i_j).
class RelativePoseCost : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  RelativePoseCost(const Pose2& T_i_j, const Eigen::Matrix3d& W) : T_i_j_(T_i_j), W_(W) {}

  bool Evaluate(double const* const* poses, double* residuals, double** jacobians) const override;

 private:
  Pose2 T_i_j_;
  Eigen::Matrix3d W_;
};

/// W e of a landmark's observation, with e = constraint_error(pose, landmark, T_sensor_landmark) at the pose a fraction
/// of the motion from the first node to the second. Blocks: first node, second node, landmark.
class LandmarkCost : public ceres::SizedCostFunction<3, 3, 3, 3> {
 public:
  LandmarkCost(double fraction, const Pose2& T_sensor_landmark, const Eigen::Matrix3d& W)
      : fraction_(fraction), T_sensor_landmark_(T_sensor_landmark), W_(W) {}

  bool Evaluate(double const* const* poses, double* residuals, double** jacobians) const override;

 private:
  double fraction_;
  Pose2 T_sensor_landmark_;
  Eigen::Matrix3d W_;
};

}  // namespace oort
