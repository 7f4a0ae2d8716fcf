// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "oort/geometry/points.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/matching/rejection.hpp"

namespace oort {

/// Where a scan fits the grid that a matcher was made with, and how well.
struct ScanMatch {
  /// kNone; or kGridEmptyScan without points, kLowScore where nothing within the window scores as much as asked for:
  /// then the pose is the guess.
  Rejection rejection = Rejection::kGridEmptyScan;
  Pose2 pose;                 ///< T_grid_sensor
  double score = 0.0;         ///< mean probability of the cells that the points lie in, unknown ones counting 0.1
  double inlier_ratio = 0.0;  ///< share of the points in cells that are rather occupied than free
  /// Of the match alone, x, y, theta along the axes of the grid [1/m^2, 1/(m rad), 1/rad^2]; may be singular. Zero
  /// where the pose is the guess.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  /// Of the match and what pulls it to the guess, same axes; positive definite where the pose is not the guess.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  long evaluations = 0;  ///< poses (or bounds on poses) that were scored, or steps of the solver

  bool usable() const { return rejection == Rejection::kNone; }
};

/// Finds where a scan fits a grid. Pure: the same call gives the same result.
class ScanMatcher {
 public:
  virtual ~ScanMatcher() = default;

  /// `points`: in the sensor frame. `guess`: T_grid_sensor to start from, or to search around. Throws InputError if the
  /// guess is not finite.
  virtual ScanMatch match(const Points& points, const Pose2& guess) const = 0;
};

}  // namespace oort
