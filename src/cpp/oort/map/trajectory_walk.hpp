// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "oort/geometry/pose2.hpp"
#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"

namespace oort {

/// A node as seen from another one.
struct PlacedNode {
  std::uint64_t node = 0;
  Pose2 T_origin_node;
};

enum class Direction { kForward, kBackward };

/// The origin and the nodes next to it in one direction, by the trajectory alone, wherever the graph's solution has
/// them: at most `count` in all, up to an edge that is too uncertain. Goes on where a new local map was begun, and
/// through nodes that only odometry placed: over the few metres that this is meant for odometry is good to centimetres.
std::vector<PlacedNode> walk_trajectory(const Map& map, const TrajectorySegments& segments, std::uint64_t origin,
                                        Direction direction, std::size_t count);

}  // namespace oort
