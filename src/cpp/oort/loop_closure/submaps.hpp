// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <frsm/contours.hpp>
#include <frsm/table.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "oort/loop_closure/submap_cache.hpp"
#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"
#include "oort/map/trajectory_walk.hpp"

namespace oort {

/// Draws the scans of some nodes into a table, in the frame of what they are seen from.
std::shared_ptr<const frsm::Table> draw_submap(const Map& map, const std::vector<PlacedNode>& nodes,
                                               const frsm::TableParams& table, const frsm::ContourParams& contours);

/// What it costs to draw a scan into a table that draws as far as `reach` [m] (geometry/work_meter.hpp).
double work_of_drawing(const PointCloud& cloud, double reach);

/// The returns of some nodes of one segment, in the frame of `origin`, a node of that segment; those farther than
/// `reach` [m] from where they were seen are left out.
frsm::Points gather_points(const Map& map, const TrajectorySegments& segments, std::uint64_t origin,
                           const std::vector<std::uint64_t>& nodes,
                           double reach = std::numeric_limits<double>::infinity());

/// The submaps that FRSM matches against.
SubmapCache<frsm::Table> table_cache(std::uint64_t neighborhood_size, std::size_t max_bytes,
                                     const frsm::TableParams& table, const frsm::ContourParams& contours);

}  // namespace oort
