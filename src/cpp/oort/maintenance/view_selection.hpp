// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"

namespace oort {

/// Which nodes of a map hold what it knows (docs/lifelong.md): a flag for each.
///
/// What a node shows is counted by piece of surface and side, in the frame of the map: older nodes first, each is kept
/// if a good part of what it shows has fewer than `views` so far, or nothing was kept of its place and heading. The
/// number that is kept is thus bounded by the area that was seen. Nodes that places are named from, that docks were
/// linked to, and the first of each part that no edge links to the rest are always kept. Parts of the map that no
/// closure ties say nothing of one another.
/// The `newest` nodes are kept, too, but take no older one's place.
std::vector<bool> select_views(const Map& map, const TrajectorySegments& segments, unsigned views,
                               std::uint64_t newest = 0);

}  // namespace oort
