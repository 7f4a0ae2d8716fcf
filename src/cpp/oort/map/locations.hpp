// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "oort/geometry/pose2.hpp"
#include "oort/map/map.hpp"

namespace oort {

// Named places of a map, kept relative to nodes so that they move with it.

/// StateError without a node.
std::uint64_t nearest_node(const Graph& graph, const Eigen::Vector2d& p_map);

/// Names a pose of the map, relative to the nearest node. An old one of the same name is replaced. StateError without a
/// node, InputError if the pose is not finite.
void create_location(Map& map, const std::string& name_space, const std::string& id, const Pose2& T_map_location);

/// Names points of the map, all relative to the node nearest to their centroid. InputError unless there is one
/// namespace and one id for each point, and all are finite.
void create_points(Map& map, const std::vector<std::string>& name_spaces, const std::vector<Eigen::Vector2d>& points,
                   const std::vector<std::string>& ids);

/// Whether there was such a location.
bool delete_location(Map& map, const std::string& name_space, const std::string& id);

/// T_map_location at the present poses.
std::optional<Pose2> locate(const Map& map, const std::string& name_space, const std::string& id);

}  // namespace oort
