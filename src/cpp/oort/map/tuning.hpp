// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace oort {

/// Constants of maps that were chosen, not derived.
struct MapTuning {
  /// [m] Standard deviation of x or y of an edge from which on no submap is drawn over it: pauses and resumed sessions
  /// inflate to metres, while an edge by odometry stays below a decimetre or two.
  static constexpr double kMaxRigidDeviation = 0.5;

  /// [m] The same of scans that are matched together as one query (walk_trajectory), which asks for more.
  static constexpr double kMaxWalkDeviation = 0.2;

  /// [m] The same of an edge from which on it tells nothing of a place: of pauses (12.6) and sessions (15.8).
  static constexpr double kMaxPlacedDeviation = 5.0;

  /// [m] Nodes lie 0.2 to 0.4 m apart where scans are taken at usual rates. Farther apart, each counts as that many of
  /// them where nodes are counted for the way between them.
  static constexpr double kNodeSpacing = 0.4;

  /// [m] Poses farther from the origin come from a broken input.
  static constexpr double kMaxCoordinate = 1e5;

  // What a map may hold, so that a map file of it can be read again (kMaxWords of storage). At 360 beams a scan, and
  // two nodes a metre, the points last for 130 km of new places.
  static constexpr std::uint64_t kMaxNodes = 1'000'000;
  static constexpr std::uint64_t kMaxEdges = 4'000'000;  ///< and of results, of each kind
  static constexpr std::uint64_t kMaxPoints = 100'000'000;
  static constexpr std::uint64_t kMaxLocations = 100'000;
  static constexpr std::size_t kMaxNameLength = 4096;  ///< [bytes] of a place's namespace and id
};

}  // namespace oort
