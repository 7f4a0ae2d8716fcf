// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "oort/geometry/pose2.hpp"
#include "oort/graph/graph.hpp"
#include "oort/map/map.hpp"
#include "oort/map/point_clouds.hpp"

namespace oort {

/// A node that local SLAM adds to a map, with what links it to the nodes before. Its id is the number of nodes before
/// it.
struct NodeAddition {
  PointClouds::Shared cloud;
  bool begins_segment = false;  ///< whether a fresh local map begins with it
  bool matched = true;          ///< whether the scan matcher, not odometry alone, placed it on its local map
  /// The earlier node that it is placed from; none if T_from_node is where it lies on the map.
  std::optional<std::uint64_t> from;
  Pose2 T_from_node;
  std::vector<Edge> edges;   ///< to earlier nodes; their ids are given when they are added
  IncrementalResult result;  ///< its T_local_id is the pose on the local map
};

}  // namespace oort
