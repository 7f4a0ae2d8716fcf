// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "oort/odometry/odometry_model.hpp"

namespace oort {

/// Constants of local SLAM that were chosen, not derived (docs/tracking.md).
struct LocalSlamTuning {
  /// [m^2, rad^2] Variance of x, y and theta of a scan that nothing was matched with: FRSM's value for its first scan.
  /// The *_cov_scale parameters scale its root.
  static constexpr double kUnmatchedVariance = 0.1;

  /// Inlier ratio from which on a match is the better guess than odometry, and tells how good odometry is.
  static constexpr double kTellingInliers = 0.8;

  /// Squared Mahalanobis distance beyond which odometry and match contradict each other: chi-square of three degrees of
  /// freedom, once in 10^5 times by chance.
  static constexpr double kContradiction = 25.9;
  /// [m, rad] How uncertain odometry then is: far more than what a match sees, less than what it does not.
  static constexpr double kContradictedSigma = 0.25;
  // Least variances of the edge that stands for both; edges as wide as that begin a segment wherever they are read.
  static constexpr double kContradictedVariance = 0.26;       ///< [m^2], for each of x and y
  static constexpr double kContradictedVarianceTheta = 0.06;  ///< [rad^2]

  /// [m^2, rad^2] Next to nothing is known (0.45 m and 0.45 rad), yet submaps may be drawn over an edge of it.
  static constexpr double kDiffuseVariance = 0.2;

  // Error of odometry, beyond its model, of one motion of several that may be true.
  static constexpr double kDoubtedSigma = 0.1;       ///< [m]
  static constexpr double kDoubtedSigmaTheta = 0.1;  ///< [rad]
  // And over an edge on which it was doubted; still one that submaps may be drawn over.
  static constexpr double kDoubtedEdgeSigma = 0.3;       ///< [m]
  static constexpr double kDoubtedEdgeSigmaTheta = 0.3;  ///< [rad]
  // The same where no match tells which motion is true: how far they are apart, up to this; just less than what begins
  // a segment (kContradictedVariance).
  static constexpr double kOpenEdgeSigma = 0.5;        ///< [m]
  static constexpr double kOpenEdgeSigmaTheta = 0.24;  ///< [rad]

  // Surfaces in the local map are off by this much from one another, which turns a scan that sees little of them. Of
  // 60 degree views in simulated homes, edges err by 0.014 rad where the returns lie within 0.5 m of their middle.
  static constexpr double kSurfaceError = 0.005;  ///< [m]
  static constexpr double kMinExtent = 0.1;       ///< [m]

  /// [rad] Beams no farther apart that end at nearly the same range see one wall, however far: most lasers step by
  /// 1 degree at most. Undone, a wall 20 m away is dots 0.35 m apart, and of fr-clinic 66 % of the scans are matched
  /// instead of 95.
  static constexpr double kMaxBeamStep = 0.02;
  /// The same of a laser with coarser steps, up to this. Undone, of edmonton with every second beam 125 of 340 scans
  /// are matched instead of 275.
  static constexpr double kWidestBeamStep = 0.08;

  // Without odometry: half widths of the search about where the last motion leads,
  static constexpr double kBlindWindow = 0.3;       ///< [m]
  static constexpr double kBlindWindowTheta = 0.6;  ///< [rad]
  /// and what that prediction is worth on an edge, in directions that the match does not see. [m, rad]
  static constexpr OdometryModel kNoOdometry{1.0, 0.3, 0.2, 0.4, 0.1, 0.05};

  // When a fresh local map begins.
  static constexpr int kMaxRejectedNodes = 5;  ///< in a row that only odometry places
  static constexpr int kMaxRejectedScans = 5;  ///< in a row that fit too little (cartographer_matcher)
  // A good match has an inlier ratio of 0.9 and more; below this it is poor, and after so many in a row the local map
  // is not of this place. Matches go on by chance after a robot was kidnapped.
  static constexpr double kPoorInliers = 0.6;
  static constexpr int kMaxPoorScans = 8;

  /// By how much the inlier ratio of another motion than odometry's must be higher to be believed.
  static constexpr double kAlternativeGain = 0.02;

  /// A node is made when scans tell of so many times the motion that makes one due, of which odometry tells less.
  static constexpr double kUnnoticedMotion = 1.5;

  /// Scans in a row without a match until the robot is lost: two seconds of a usual sensor.
  static constexpr int kLostScans = 20;
};

}  // namespace oort
