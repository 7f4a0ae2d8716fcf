// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "oort/loop_closure/statistics.hpp"
#include "oort/map/map.hpp"
#include "oort/merging/map_placement.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// A place of the second map that was left out, as the first has it already.
struct DroppedLocation {
  std::string name_space;
  std::string id;
  double distance = 0.0;  ///< from the place of the first map that is kept instead [m]
};

/// What came of merging two maps.
struct Merged {
  Map map;
  std::uint64_t first_node_b = 0;  ///< the nodes of map a have the ids before it
  MapPlacement placement;          ///< where map b was found on map a, before anything was solved
  int views = 0;                   ///< that were asked
  ClosureCounts across;            ///< closures from nodes of map b to nodes of map a
  std::uint64_t across_kept = 0;   ///< of the accepted ones: on at the last solution
  std::vector<DroppedLocation> dropped;
};

/// Joins two maps of the same home: map b's nodes become further segments of map a, in whose frame the result is, and
/// loop closures from each node of map b tie them to it. Neither map is changed; deterministic.
///
/// `T_a_b` says about where map b's origin lies on map a, within a step and some degrees; without it that is found:
/// at the docks, or by a search of the whole map (map_placement.hpp). Of places with the same namespace and id, and of
/// docks at the same place, those of map a are kept.
///
/// Throws InputError if a map is empty or contradicts itself, if the maps have scans in common, if `T_a_b` is not
/// finite or beyond 100 km, if map b is not found on map a or in more than one place, or if closures do not confirm
/// what was found; ParameterError as Mapper does.
Merged merge_maps(const Map& a, const Map& b, const Parameters& parameters,
                  const std::optional<Pose2>& T_a_b = std::nullopt);

}  // namespace oort
