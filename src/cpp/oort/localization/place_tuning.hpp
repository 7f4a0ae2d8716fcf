// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace oort {

/// Constants of finding nodes on the rest of their map that were chosen, not derived (docs/tracking.md).
struct PlaceTuning {
  // What one search may cost while mapping: about 0.1 s at most. Searches that find something in homes cost a third.
  /// Places that score less are not looked at: answers score 0.8 and more (homes). A search that finds nothing is the
  /// dearest, as no good place prunes it.
  static constexpr double kLeastScore = 0.6;
  /// By which a step of the heading moves the farthest point: half the headings, for a table that is blurred by more.
  static constexpr double kTurnCells = 2.0;
  /// Least share of the best score that a rival has. To 0.75, as for a robot that is looked for on a saved map, the
  /// search of fr079 would not end; the support of what scores less differs by relocalizer.min_lead anyway.
  static constexpr double kRivalScore = 0.85;
  static constexpr std::size_t kSearchPoints = 250;
  static constexpr std::size_t kSearchExpansions = 60000;
  /// Where a place is found, it is so before; on large grounds most searches find none.
  static constexpr std::size_t kExpansionsToFirst = 4;  ///< one part in so many
  static constexpr std::size_t kSearchPeaks = 8;        ///< where more score as well, the place is ambiguous
  static constexpr std::size_t kNodesPerSearch = 11;    ///< that are looked for together: some 2 m of travel
  static constexpr std::uint64_t kNodesWalked = 200;    ///< at most, to collect views that are apart

  // Two answers agree within this; what they say of a bent map is no better.
  static constexpr double kSameAnswer = 0.3;        ///< [m]
  static constexpr double kSameAnswerAngle = 0.15;  ///< [rad]
  static constexpr double kAnswerTravel = 0.3;      ///< [m] from one answer to the next

  // An answer of less support than one must have by itself is weak, if what does not lie on known surfaces lies where
  // nothing is known: a robot in a corner that was not mapped.
  static constexpr double kWeakSupport = 0.65;
  static constexpr double kWeakContradictions = 0.1;  ///< share of the returns behind walls or on free floor, at most
  static constexpr double kWeakWeight = 0.5;          ///< so many answers it counts as
  // Errors of an answer that the shape of its match does not show.
  static constexpr double kAnswerSigma = 0.05;        ///< [m]
  static constexpr double kAnswerSigmaTheta = 0.015;  ///< [rad]

  /// Share of the returns behind walls or on free floor from which on what was seen contradicts where the map has it.
  static constexpr double kContradictingShare = 0.3;

  // An answer nearer to where the map has the robot is drift: closures mend it.
  static constexpr double kCarried = 1.0;       ///< [m]
  static constexpr double kCarriedAngle = 0.5;  ///< [rad]

  static constexpr double kReferenceMoved = 0.1;  ///< [m] by which a node moves until the map is drawn anew,
  /// which is done once the map has grown by one part in so many: all drawings together cost four of the final map's
  static constexpr std::uint64_t kRedrawParts = 3;

  // Work units (geometry/work_meter.hpp).
  static constexpr double kWorkPerReferencePoint = 2.5;
  static constexpr double kWorkPerLookup = 0.002;
  static constexpr double kWorkPerRayStep = 0.006;
  static constexpr double kWeighedPlaces = 2.0;  ///< per search, usually
};

}  // namespace oort
