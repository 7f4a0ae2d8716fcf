// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "oort/grid/probability_grid.hpp"
#include "oort/matching/scan_matcher.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// Refines a guess to a fraction of a cell (Hess et al. 2016, equation CS): minimises over T
///
///   w_o^2 / n  sum_i (1 - M(T p_i))^2  +  w_t^2 |t - t_target|^2  +  w_r^2 (theta - theta_guess)^2
///
/// with M the bicubic interpolation of the grid's probabilities between the centres of cells, and 0.1 where nothing is
/// known. It finds the optimum next to the guess only.
///
/// The covariance is covariance_scale (J^T J)^-1 at the solution, J being the Jacobian of all terms; the information is
/// J^T J / covariance_scale of the first term alone.
class CeresMatcher : public ScanMatcher {
 public:
  /// `grid` must outlive the matcher.
  CeresMatcher(const ProbabilityGrid& grid, const CeresScanMatcherParameters& parameters)
      : grid_(grid), parameters_(parameters) {}

  /// Keeps to the position of the guess.
  ScanMatch match(const Points& points, const Pose2& guess) const override {
    return match(points, guess, guess.translation());
  }

  /// Keeps to another position than that of the guess, for instance the one expected before a coarser match.
  ScanMatch match(const Points& points, const Pose2& guess, const Eigen::Vector2d& target) const;

 private:
  const ProbabilityGrid& grid_;
  CeresScanMatcherParameters parameters_;
};

}  // namespace oort
