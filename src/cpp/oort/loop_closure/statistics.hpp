// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "oort/matching/rejection.hpp"

namespace oort {

/// What became of the attempts to close loops. Every attempt is counted once: accepted, or rejected.
struct ClosureCounts {
  std::uint64_t tried = 0;
  std::uint64_t accepted = 0;
  RejectionCounts rejected;
};

/// What the last refinement did (refinement.hpp).
struct RefinementCounts {
  std::uint64_t rounds = 0;
  ClosureCounts links;         ///< between scans, in the last round
  double misfit_before = 0.0;  ///< root mean square distance between the surfaces that scans have in common [m]
  double misfit = 0.0;         ///< the same afterwards [m]
  bool kept = false;           ///< whether the map was changed: only if scans agree better than before
  double moved = 0.0;          ///< root mean square of how far nodes were moved [m]
};

/// How many scans ended in each tracking state.
struct TrackingCounts {
  std::uint64_t tracking = 0;
  std::uint64_t uncertain = 0;
  std::uint64_t lost = 0;
  std::uint64_t changes = 0;  ///< from one state to another
};

/// What the solutions made of the closures that were accepted (a switch below 0.5 is off).
struct SolvedCounts {
  std::uint64_t kept = 0;          ///< on at the last solution
  std::uint64_t contradicted = 0;  ///< off at the last solution
  std::uint64_t came_back = 0;     ///< times that one which was off was on at a later solution
};

/// Counts since the mapper was made.
struct MapperStatistics {
  std::uint64_t scans = 0;
  std::uint64_t scans_too_small = 0;  ///< fewer returns than min_pointcloud_size: carried by odometry
  std::uint64_t scans_matched = 0;
  std::uint64_t nodes = 0;
  std::uint64_t odometry_links = 0;  ///< nodes whose match was rejected
  RejectionCounts match_rejections;  ///< of nodes
  std::uint64_t contradictions = 0;  ///< chains begun as odometry and scans disagreed
  TrackingCounts tracking;
  ClosureCounts loops;
  ClosureCounts docks;
  SolvedCounts solved;
  std::uint64_t solves = 0;
  std::uint64_t solves_cut_short = 0;  ///< that ended before they converged
  RefinementCounts refinement;
};

}  // namespace oort
