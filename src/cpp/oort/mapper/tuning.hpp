// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace oort {

/// Constants of the lanes that were chosen, not derived (docs/architecture.md, two lanes).
struct MapperTuning {
  /// Share of the time between scans that global SLAM is granted, on a laptop. On a machine five times slower it is
  /// half a core.
  static constexpr double kGlobalShare = 0.1;

  // Limits within which the time between scans is believed as stamps tell it.
  static constexpr double kMinInterval = 0.02;  ///< [s]
  static constexpr double kMaxInterval = 0.5;   ///< [s]

  // Motion since the dock was linked within which the robot is still parked there: scans differ by less while it
  // stands.
  static constexpr double kParkedDistance = 0.03;  ///< [m]
  static constexpr double kParkedAngle = 0.03;     ///< [rad]

  // Iterations of a solve.
  static constexpr int kIterations = 15;        ///< while mapping or merging: the poses start near the optimum
  static constexpr int kFinalIterations = 100;  ///< when mapping stops

  // When to solve.
  static constexpr std::uint64_t kMinProgress = 10;    ///< nodes (merging: closures) between solves of the whole graph
  static constexpr std::uint64_t kGrowthParts = 20;    ///< the graph grows by one part in so many between them
  static constexpr std::uint64_t kNewestNodes = 1000;  ///< that are moved when a large graph has a large innovation
};

}  // namespace oort
