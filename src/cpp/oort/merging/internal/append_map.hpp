// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "oort/map/map.hpp"

namespace oort {

/// Adds a copy of another map's nodes, clouds, links, closures, results and places to a map, with ids that follow on
/// those of the map, and moved by T_map_other: segments of their own that nothing links to the others yet. Places are
/// added as they are, whatever they are called. Both maps must be such that find_defect() accepts them. Returns the
/// first id of the nodes that were added.
std::uint64_t append_map(const Map& other, const Pose2& T_map_other, Map& map);

/// How many scans are in both maps: same stamp, same points. More than none means that a map is a copy of the other, or
/// goes on with it.
std::uint64_t count_common_scans(const Map& a, const Map& b);

}  // namespace oort
