// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/matching/internal/matching_costs.hpp"

#include <Eigen/Core>
#include <cmath>

#include "oort/geometry/pose2.hpp"

namespace oort {

OccupiedSpaceCost::OccupiedSpaceCost(const Points& points, const ProbabilityGrid& grid, double weight)
    : points_(points),
      limits_(grid.limits()),
      probabilities_(grid),
      interpolator_(probabilities_),
      factor_(weight / std::sqrt(static_cast<double>(points.size()))) {
  set_num_residuals(static_cast<int>(points.size()));
  mutable_parameter_block_sizes()->push_back(3);
}

bool OccupiedSpaceCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const double* const pose = parameters[0];
  const Eigen::Matrix2d R = rotation(pose[2]);
  const Eigen::Vector2d t(pose[0], pose[1]);
  double* jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector2d turned = R * points_[i];
    const Eigen::Vector2d cells = limits_.to_cells(turned + t);
    double value, by_row, by_column;  // the interpolator counts from the centres of cells
    interpolator_.Evaluate(cells.y() - 0.5, cells.x() - 0.5, &value, &by_row, &by_column);
    residuals[i] = factor_ * (1.0 - value);
    if (jacobian != nullptr) {
      const double by_x = -factor_ * by_column / limits_.resolution;
      const double by_y = -factor_ * by_row / limits_.resolution;
      jacobian[3 * i] = by_x;
      jacobian[3 * i + 1] = by_y;
      jacobian[3 * i + 2] = by_y * turned.x() - by_x * turned.y();  // d(R p) / dtheta = (-y, x) of R p
    }
  }
  return true;
}

DeltaCost::DeltaCost(const Eigen::Vector2d& target, double theta, double translation_weight, double rotation_weight)
    : expected_(target.x(), target.y(), theta), weights_(translation_weight, translation_weight, rotation_weight) {
  set_num_residuals(3);
  mutable_parameter_block_sizes()->push_back(3);
}

bool DeltaCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  for (int k = 0; k < 3; ++k) residuals[k] = weights_[k] * (parameters[0][k] - expected_[k]);
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> jacobian(jacobians[0]);
    jacobian = weights_.asDiagonal();
  }
  return true;
}

}  // namespace oort
