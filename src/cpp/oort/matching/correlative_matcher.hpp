// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "oort/grid/probability_grid.hpp"
#include "oort/matching/scan_matcher.hpp"

namespace oort {

struct CorrelativeOptions {
  double linear_search_window = 0.1;           ///< half width [m]
  double angular_search_window = 0.1;          ///< half width [rad]
  double translation_delta_cost_weight = 0.1;  ///< [1/m]
  double rotation_delta_cost_weight = 0.1;     ///< [1/rad]
};

/// Scores every pose of a lattice around the guess: cells apart in x and y, angular_step() apart in heading. The best
/// is that with the greatest mean probability times exp(-(w_t |dt| + w_r |dtheta|)^2), the nearest to the guess among
/// equal ones (Olson 2009). Accurate to half a cell; meant for short motions between scans.
class CorrelativeMatcher : public ScanMatcher {
 public:
  /// `grid` must outlive the matcher.
  CorrelativeMatcher(const ProbabilityGrid& grid, const CorrelativeOptions& options) : grid_(grid), options_(options) {}

  ScanMatch match(const Points& points, const Pose2& guess) const override;

 private:
  const ProbabilityGrid& grid_;
  CorrelativeOptions options_;
};

}  // namespace oort
