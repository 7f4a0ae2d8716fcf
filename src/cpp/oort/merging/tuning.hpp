// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace oort {

/// Constants of merging that were chosen, not derived (docs/merging.md).
struct MergingTuning {
  // Views of the smaller map that are looked for on the other.
  static constexpr std::size_t kMaxViews = 40;
  static constexpr double kViewSpacing = 0.7;         ///< [m]
  static constexpr std::uint64_t kNodesPerView = 11;  ///< some 2 m of travel
  static constexpr std::size_t kMaxPlacements = 8;    ///< that are weighed

  // Two placements are the same if they put a view to within this of one another: maps are bent.
  static constexpr double kSamePlacement = 0.5;        ///< [m]
  static constexpr double kSamePlacementAngle = 0.15;  ///< [rad]

  // Where a view is matched, around its place.
  static constexpr double kMatchReach = 0.5;        ///< [m]
  static constexpr double kMatchReachAngle = 0.15;  ///< [rad]
  static constexpr double kMatchVoxel = 0.1;        ///< [m]

  // Shares of the returns of a view.
  static constexpr double kFits = 0.75;        ///< least support of a view that fits
  static constexpr double kContradicts = 0.3;  ///< share that cannot be, beyond which a view contradicts

  /// Views that must fit. One or two scenes look like one or two of some other home now and then (1 of 30 tries).
  static constexpr int kNeededViews = 3;

  static constexpr double kSameDock = 0.5;  ///< [m] between docks that are one
  static constexpr int kMaxDockPairs = 9;   ///< that are tried

  /// Views that must fit for each that contradicts, once closures have straightened the map: furniture is moved.
  /// Before, more must fit than contradict, as the map may be bent.
  static constexpr int kFitsPerContradiction = 2;

  /// Another placement with more than this share of the best one's score is as good.
  static constexpr double kAmbiguousShare = 0.6;
  /// The one at the docks is preferred if its score is at least this share of the best one's.
  static constexpr double kDockShare = 0.9;

  // Accepted closures across, and the share of them that the solution keeps, without which nothing is believed.
  static constexpr std::uint64_t kMinKept = 3;
  static constexpr double kMinKeptShare = 0.5;

  // How well a view tells where its map lies on the other, while closures are looked for.
  static constexpr double kJointSigma = 0.15;       ///< [m]
  static constexpr double kJointSigmaTheta = 0.05;  ///< [rad]
};

}  // namespace oort
