// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <ceres/cost_function.h>
#include <ceres/cubic_interpolation.h>

#include "oort/geometry/points.hpp"
#include "oort/grid/probability_grid.hpp"

/// The terms that CeresMatcher minimises, each of one parameter block x, y, theta, with analytic Jacobians. Needs
/// Ceres' headers, so it is not installed.
namespace oort {

/// A probability grid as Ceres' interpolator reads it: unbounded, 0.1 where nothing is known.
class GridProbabilities {
 public:
  enum { DATA_DIMENSION = 1 };

  explicit GridProbabilities(const ProbabilityGrid& grid) : grid_(grid) {}

  void GetValue(int row, int column, double* value) const { *value = grid_.probability(column, row); }

 private:
  const ProbabilityGrid& grid_;
};

/// Residual i: w_o / sqrt(n) (1 - M(T p_i)).
class OccupiedSpaceCost : public ceres::CostFunction {
 public:
  /// `points` and `grid` must outlive the cost.
  OccupiedSpaceCost(const Points& points, const ProbabilityGrid& grid, double weight);

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const Points& points_;
  const GridLimits& limits_;
  GridProbabilities probabilities_;
  ceres::BiCubicInterpolator<GridProbabilities> interpolator_;
  double factor_;
};

/// Residuals w_t (t - target) and w_r (theta - guess).
class DeltaCost : public ceres::CostFunction {
 public:
  DeltaCost(const Eigen::Vector2d& target, double theta, double translation_weight, double rotation_weight);

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  Eigen::Vector3d expected_;
  Eigen::Vector3d weights_;
};

}  // namespace oort
