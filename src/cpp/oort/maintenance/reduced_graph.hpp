// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"

namespace oort {

/// A graph between some of a map's nodes. What is indexed by node has an entry for each node of the map, kept or not.
struct ReducedGraph {
  Graph graph;
  std::vector<LoopResult> loop_results;
  std::vector<std::uint64_t> new_id;   ///< of a kept node
  std::vector<std::uint64_t> carrier;  ///< new id of the node itself, or of the kept node that its place is known by
  std::vector<std::uint64_t> parent;   ///< of a kept node: the kept node before it on its trajectory, or itself
  std::vector<Pose2> T_parent_node;
};

/// Leaves out the nodes that are not kept. The first node of each trajectory must be kept.
ReducedGraph reduce(const Map& map, const TrajectorySegments& segments, const std::vector<bool>& kept);

}  // namespace oort
