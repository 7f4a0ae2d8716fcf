// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/graph/graph.hpp"
#include "oort/map/trajectory_segments.hpp"

namespace oort {

/// For each node, the first node of the part of the map that it belongs to: segments that closures tie, as far as they
/// are on. Where parts lie to one another only odometry or somebody's word tells.
std::vector<std::uint64_t> tied_parts(const Graph& graph, const TrajectorySegments& segments);

/// The same of what closures alone hold together: odometry may be wrong wherever a new local map was begun.
std::vector<std::uint64_t> closed_parts(const Graph& graph, const TrajectorySegments& segments);

}  // namespace oort
