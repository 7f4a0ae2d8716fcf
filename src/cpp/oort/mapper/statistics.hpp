// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/local_slam/local_slam.hpp"
#include "oort/loop_closure/statistics.hpp"

namespace oort {

/// What the solutions made of the closures that were accepted (a switch below 0.5 is off).
struct SolvedCounts {
  std::uint64_t kept = 0;          ///< on at the last solution
  std::uint64_t contradicted = 0;  ///< off at the last solution
  std::uint64_t came_back = 0;     ///< times that one which was off was on at a later solution
};

/// Counts of the global lane.
struct GlobalCounts {
  ClosureCounts loops;
  ClosureCounts docks;
  SolvedCounts solved;
  std::uint64_t solves = 0;
  std::uint64_t solves_cut_short = 0;  ///< that ended before they converged
  RefinementCounts refinement;
};

/// Counts since the mapper was made.
struct MapperStatistics {
  LocalCounts local;
  TrajectoryCounts trajectory;
  TrackingCounts tracking;
  GlobalCounts global;
  std::uint64_t odometry_fault_count = 0;
  std::vector<OdometryFault> odometry_faults;  ///< the first 1000
  double odometry_way_scale = 1.0;             ///< how far the base really drives where odometry says 1, by the matches
  double odometry_turn_scale = 1.0;            ///< and turns
  std::vector<LaserFindings> lasers;           ///< the main one first
};

}  // namespace oort
