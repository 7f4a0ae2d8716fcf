// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "oort/geometry/chi_square.hpp"

namespace oort {

/// Constants of loop closure that were chosen, not derived (docs/loops.md).
struct LoopClosureTuning {
  /// Squared Mahalanobis distance from what the graph expects beyond which a closure is solved for at once.
  static constexpr double kLargeInnovation = ChiSquare3::k99;

  // The search window is never smaller: what is believed to be known well may be known worse.
  static constexpr double kMinWindow = 0.4;        ///< [m]
  static constexpr double kMinWindowTheta = 0.15;  ///< [rad]

  /// Standard deviations that a reach stands for: of how much farther candidates may be for being uncertain; of the
  /// dock's contacts and moves, which are limits, not deviations.
  static constexpr double kReachSigmas = 2.0;

  // Beyond this half width one scan is too little to go by: the scans of the last metres are matched together.
  static constexpr double kWideWindow = 0.7;  ///< [m]
  static constexpr std::uint64_t kWideStride =
      4;  ///< every how many-th node looks that far: what it sees changes little
  static constexpr std::uint64_t kWideQueryNodes = 31;
  static constexpr std::uint64_t kWideSubmapNodes = 61;
  static constexpr std::size_t kWideCoarsePoints = 250;  ///< of the search over the whole window
  static constexpr std::size_t kWideFinePoints = 1000;   ///< of the search around its result
  static constexpr double kWideMaxAmbiguity = 0.9;       ///< second best score elsewhere, as a share of the best
  static constexpr double kWideReach = 8.0;              ///< [m] from its sensor within which a return counts

  /// [m] A node that is farther from its submap's comes from a damaged map, and would make the table larger than
  /// memory: neighbouring nodes lie a metre apart. Of the public logs, sparse ones among them, none comes near.
  static constexpr double kMaxSubmapReach = 50.0;

  // Errors of a closure that the shape of its match does not show, as standard deviations: submaps are bent, and walls
  // look thicker or thinner from elsewhere. Of one scan: mean ATE of 20 simulated homes 0.0122 m instead of 0.0143 m
  // without.
  static constexpr double kScanSigma = 0.03;        ///< [m]
  static constexpr double kScanSigmaTheta = 0.008;  ///< [rad]
  // Of the last metres.
  static constexpr double kWideSigma = 0.05;        ///< [m]
  static constexpr double kWideSigmaTheta = 0.015;  ///< [rad]
  // Of the dock: matched closures in homes seen with 60 degrees are off by up to 7 cm and 4 degrees where every point
  // fits.
  static constexpr double kDockSigma = 0.03;       ///< [m]
  static constexpr double kDockSigmaTheta = 0.02;  ///< [rad]

  // A closure that moves the newest node by more waits for others that agree.
  static constexpr double kUnconfirmedDistance = 0.5;  ///< [m]
  static constexpr double kUnconfirmedAngle = 0.15;    ///< [rad]
  static constexpr std::uint64_t kConfirmationAge =
      60;                                             ///< [nodes]; drift within so many is small beside the tolerances
  static constexpr std::size_t kConfirmations = 2;    ///< closures that agree
  static constexpr double kConfirmationTravel = 1.5;  ///< [m] between the first and the last of them
  static constexpr double kConfirmationDistance = 0.2;  ///< [m] within which they agree
  static constexpr double kConfirmationAngle = 0.1;     ///< [rad]

  // Normal consistency.
  static constexpr double kNormalCell =
      0.1;                                   ///< [m]; a wall's two sides are farther apart or fall together if mistaken
  static constexpr double kMinCosine = 0.7;  ///< surfaces that turn more (45 degrees) are not the same line

  // How far around the coarse match the fine one looks.
  static constexpr double kFineCells = 3.0;
  static constexpr double kFineThetaSteps = 4.0;

  /// A wide search that finds nothing is by far the most expensive, as no good pose prunes it. It ends early below the
  /// score that a match with enough inliers has anyway: this much of the inlier ratio that is asked for. Accepted
  /// ones score 0.92 of it and more, but one of 3,900 on the logs of CSAIL and Killian court.
  static constexpr double kScorePerInlier = 0.75;

  /// Bytes of submaps in memory at once: enough for the places a robot passes between two visits to one of them.
  static constexpr std::size_t kSubmapCacheBytes = std::size_t{128} << 20;
  /// Scans of a submap that are drawn in one piece of work: about as much work as a match.
  static constexpr std::size_t kScansPerPiece = 8;

  // Work units (geometry/work_meter.hpp).
  static constexpr double kWorkPerNode = 0.25;          ///< of the map: candidates
  static constexpr double kWorkPerEdge = 0.085;         ///< of the map: candidates
  static constexpr double kWorkPerNormal = 0.4;         ///< per return: normal consistency
  static constexpr double kFrsmWorkPerDrawn = 0.5;      ///< per return of a submap,
  static constexpr double kFrsmWorkPerMetre = 6.0;      ///< and per metre between returns that lie on one line, which
  static constexpr double kLongestLine = 0.5;           ///< [m] are no farther apart
  static constexpr double kFrsmWorkPerPoint = 0.5;      ///< of a match, beside the search
  static constexpr double kFrsmWorkPerLookup = 0.0015;  ///< of one cell of a table (frsm::OnLookups)
  static constexpr double kGridWorkPerDrawn = 2.0;      ///< per return of a submap
  static constexpr double kGridWorkPerMatch = 5000.0;   ///< refinement by Ceres
  static constexpr double kGridWorkPerTurn = 50.0;      ///< search: per point and radian of the window
};

}  // namespace oort
