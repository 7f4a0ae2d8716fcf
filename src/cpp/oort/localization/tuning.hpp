// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "oort/geometry/chi_square.hpp"

namespace oort {

/// Constants of localisation that were chosen, not derived (docs/localization.md).
struct LocalizationTuning {
  // Added to a match's standard deviations, as its shape does not show them: the map's own errors, and that scans at
  // the same place err alike.
  static constexpr double kSigmaFloorXy = 0.02;      ///< [m]
  static constexpr double kSigmaFloorTheta = 0.006;  ///< [rad]

  // The search window around the expected pose.
  static constexpr double kWindowSigmas = 3.0;     ///< half width, in standard deviations
  static constexpr double kMinWindowXy = 0.08;     ///< [m]
  static constexpr double kMinWindowTheta = 0.06;  ///< [rad]

  /// Squared Mahalanobis distance from what odometry expects beyond which a match is of something else, say of
  /// furniture that was moved: one scan of that fits well a little off. Only a search with several scans moves the pose
  /// so far.
  static constexpr double kMaxInnovation = ChiSquare3::k999;

  // Scans in a row without a match from which on a robot that stands is uncertain, too: it may have been kidnapped.
  static constexpr int kDoubtfulScans = 10;
  static constexpr double kMinUnexplainedSupport = 0.3;  ///< of a scan that the map merely does not explain
  static constexpr int kContradictionCounts = 4;         ///< doubtful scans that one with less support counts as

  // A pose that was followed for long is not given up for one search's answer: another search, this much farther on,
  // must agree with it to this.
  static constexpr double kRivalTravel = 0.5;  ///< [m]
  static constexpr double kRivalXy = 0.15;     ///< [m]
  static constexpr double kRivalTheta = 0.1;   ///< [rad]

  static constexpr double kLostFactor = 3.0;  ///< distance without a match until lost, in those until uncertain

  // A match so far from where odometry leads is believed only if the views of the last metres do not fit worse there:
  // furniture that was moved can explain a scan at a wrong place, but not what was seen on the way to it. Only the
  // position counts: cheap odometry turns too far by more than that without harm.
  static constexpr double kJump = 0.15;  ///< [m]
  static constexpr std::size_t kRememberedViews = 12;
  static constexpr double kMuchLessSupport = 0.05;  ///< worse fit, as a difference of support

  // After a match that is a little off, above all where scans did not fit before, more travel must fit before the pose
  // is relied on.
  static constexpr double kInnovationXy = 0.12;    ///< [m]
  static constexpr double kInnovationTheta = 0.1;  ///< [rad]
  static constexpr int kFewScans = 3;              ///< doubtful scans from which on the angle counts

  // The search of the whole map.
  static constexpr double kLoneLead = 1.5;       ///< times min_lead, of one scan: who stands before it hides much of it
  static constexpr double kSearchVoxel = 0.1;    ///< [m] of the points that are looked for everywhere
  static constexpr double kMatchVoxel = 0.05;    ///< [m] of those that are matched around each peak
  static constexpr double kMinScore = 0.01;      ///< that a peak can be asked for
  static constexpr double kPeakSpacing = 0.3;    ///< [m] and [rad] between two places
  static constexpr double kFineReach = 0.1;      ///< [m] around a peak
  static constexpr double kMinThetaStep = 0.01;  ///< [rad]
  static constexpr double kMaxThetaStep = 0.05;  ///< [rad]
  static constexpr double kCoarseCell = 0.05;    ///< [m]
  static constexpr double kCoarseSigma = 0.08;   ///< [m]; a pose half a cell and half a step off still scores
  static constexpr double kBlockedMargin = 0.25;  ///< [m] before a return where a wall may be the one that it is on
  static constexpr double kBlockedWeight = 1.0;   ///< of a return behind a wall against one that fits, in the support
  static constexpr double kTurnedWeight = 1.0;    ///< of a return on a surface that faces the other way, the same

  // The reference map's walls, floor and normals. A cell that was hit more often than passed is a wall.
  static constexpr double kCell = 0.05;            ///< [m]
  static constexpr double kMaxCells = 6e6;         ///< of a grid: of 150 m x 100 m; a larger area has larger ones,
  static constexpr double kLargestCell = 0.2;      ///< up to [m]
  static constexpr double kHitProbability = 0.65;  ///< of one observation
  static constexpr double kMissProbability = 0.45;
  static constexpr double kWall = 0.6;      ///< probability above which a cell is a wall,
  static constexpr double kFree = 0.4;      ///< and below which free floor
  static constexpr int kNormalSectors = 8;  ///< in which the normals of a cell's surfaces are kept
};

}  // namespace oort
