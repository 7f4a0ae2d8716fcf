// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "oort/geometry/pose2.hpp"
#include "oort/map/map.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// Where one map may lie on another, and what views of it say to that.
struct MapPlacement {
  Pose2 T_a_b;               ///< takes coordinates of map b to those of map a
  std::string found_by;      ///< "given", "dock" or "search"
  int fits = 0;              ///< views of the searched map that fit the other there
  int contradicts = 0;       ///< views that cannot be there: they see through walls, or walls where the floor is free
  std::uint64_t node_a = 0;  ///< two nodes, one of each map, that are near to each other in the view that fits best
  std::uint64_t node_b = 0;

  /// What speaks for it.
  int score() const { return fits - contradicts; }
};

/// What a search for a map on another found.
struct MapSearch {
  std::vector<MapPlacement> placements;  ///< apart from each other, the best first
  int views = 0;                         ///< that were looked for
  int needed = 0;  ///< views that must fit; of a very small map that is searched for there are not so many
};

/// Looks for map b on map a. `guesses` are tried, too: placements of which T_a_b and found_by are set. With
/// `only_guesses` there is no search without a guess. Work is bounded by counts; deterministic.
///
/// Views of the smaller map, some metres of trajectory each, are looked for on all of the larger one without a guess
/// (Relocalizer); each answer, accepted or not, is a placement of the map. Of those that most others agree with, each
/// is weighed: every view is matched near to where it should be then, and either fits, contradicts, or does neither.
///
/// Throws InputError if a map is empty or contradicts itself.
MapSearch find_placements(const Map& a, const Map& b, const Parameters& parameters,
                          const std::vector<MapPlacement>& guesses, bool only_guesses);

}  // namespace oort
