// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "oort/localization/relocalizer.hpp"
#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"

namespace oort {

/// What was seen around one place of a map: the scans of some metres of trajectory, joined as the scan matcher joined
/// them.
struct MapView {
  std::uint64_t node = 0;         ///< the place
  Pose2 T_map_sensor;             ///< of the last of the scans
  std::vector<PlacedScan> scans;  ///< in the order of their nodes
};

/// Views of a map spread evenly over it: each is of the place that is farthest from those before it, until there are
/// `max_views`, or none is left that is at least `spacing` [m] away. `nodes`: how many scans a view has at most.
std::vector<MapView> spread_views(const Map& map, const TrajectorySegments& segments, std::size_t max_views,
                                  double spacing, std::uint64_t nodes);

}  // namespace oort
