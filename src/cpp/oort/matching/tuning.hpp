// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace oort {

/// Constants of the matchers on probability grids that were chosen, not derived.
struct MatchingTuning {
  /// Probability above which a return's cell counts as occupied, and the return as an inlier.
  static constexpr double kOccupied = 0.5;

  /// Cells from the sensor within which a point counts as being so far, or the angular step would be a half turn.
  static constexpr double kNearestCells = 3.0;

  /// Of the search, to each side: finer steps than these lie below a sensor's.
  static constexpr int kMaxTurns = 1000;

  /// Steps each way from the best pose that its covariance is taken from.
  static constexpr int kCovarianceSteps = 3;

  /// Added to J^T J so that a direction that nothing holds has a large variance and no infinite one.
  static constexpr double kMinInformation = 1e-6;
};

}  // namespace oort
