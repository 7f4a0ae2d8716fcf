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

}  // namespace oort
