// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace oort {

/// Constants of the refinement of a map that were chosen, not derived (docs/refinement.md).
struct RefinementTuning {
  // Surface pieces of a scan.
  static constexpr double kPieceLength = 0.2;     ///< [m]
  static constexpr double kMinPieceLength = 0.1;  ///< [m] of what is left at the end of a surface
  static constexpr double kMaxPieceLength = 0.6;  ///< [m]; returns so sparse are no line
  static constexpr std::size_t kMinPieceReturns = 3;
  static constexpr double kMaxPieceThickness = 0.2;  ///< standard deviation across a piece, as a share of that along it

  // Pairs of scans that may show the same surfaces.
  static constexpr double kPairReach = 1.5;          ///< [m] between the middles of what two nodes saw
  static constexpr std::size_t kMaxPartners = 8;     ///< of a node
  static constexpr std::size_t kPartnerSpacing = 2;  ///< [nodes] between partners

  // Pieces of one surface begin anywhere, so their middles are up to a length apart along it.
  static constexpr double kMaxAlong = 0.2;   ///< [m]
  static constexpr double kMinCosine = 0.9;  ///< of their normals (26 degrees)

  // How far apart pieces of one surface are: noise, and errors of range that change with distance and incidence. Beyond
  // the scale of the robust weight it is likely to be another surface.
  static constexpr double kPieceSigma = 0.02;   ///< [m]
  static constexpr double kRobustScale = 0.04;  ///< [m]

  /// Share of a piece's information that counts: each takes part in several pairs of scans, and neighbouring ones share
  /// their error.
  static constexpr double kInformationShare = 0.25;

  /// A direction is open if the information on it is less than this share of what walls across it would give: crooked
  /// normals give a corridor's axis about a hundredth. A radian counts as a metre.
  static constexpr double kMinCurvature = 0.03;

  static constexpr int kRounds = 4;           ///< of pairing and solving
  static constexpr int kSolverSteps = 2;      ///< per round: what is paired changes with the next
  static constexpr double kTolerance = 1e-3;  ///< of the cost, at which a round's solving ends

  // How far apart surfaces may be to be taken for the same, at first and once they were brought together.
  static constexpr double kInitialDistance = 0.2;  ///< [m]
  static constexpr double kDistance = 0.1;         ///< [m]

  // Two scans with less in common are not linked.
  static constexpr int kMinPieces = 4;
  static constexpr double kMinShare = 0.15;  ///< of the pieces of the scan that has fewer

  /// [rad] A larger correction is not within reach of the surfaces that it was found with.
  static constexpr double kMaxTurn = 0.1;

  // What a closure still counts: it was made from the same scans, less precisely.
  static constexpr double kClosureShare = 0.1;  ///< of its information
  static constexpr double kMinSwitch = 0.3;     ///< below which it is left out

  /// Squared error at which an edge between scans counts half, once all have pulled together.
  static constexpr double kRobustSquaredError = 4.0;
};

}  // namespace oort
