// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "oort/matching/bound_grids.hpp"
#include "oort/matching/scan_matcher.hpp"

namespace oort {

struct FastCorrelativeOptions {
  double linear_search_window = 7.0;     ///< half width [m]
  double angular_search_window = 0.524;  ///< half width [rad]; from pi on all headings
  double min_score = 0.55;               ///< less is kLowScore
};

/// Finds the best pose of a lattice around the guess, cells apart in x and y and angular_step() apart in heading, that
/// scores more than min_score, as exhaustive search would, but by branch and bound (Hess et al. 2016, algorithm 3): a
/// box of poses whose bound is no better than the best pose found is left out.
class FastCorrelativeMatcher : public ScanMatcher {
 public:
  /// Throws ParameterError for windows that are negative or not finite.
  FastCorrelativeMatcher(std::shared_ptr<const BoundGrids> grids, const FastCorrelativeOptions& options);

  ScanMatch match(const Points& points, const Pose2& guess) const override;

 private:
  struct Search;

  void describe(const Points& points, double turn, ScanMatch& match) const;

  std::shared_ptr<const BoundGrids> grids_;
  FastCorrelativeOptions options_;
};

}  // namespace oort
