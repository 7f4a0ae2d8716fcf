// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/map/map_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "oort/geometry/errors.hpp"
#include "oort/geometry/tuning.hpp"
#include "oort/graph/graph_check.hpp"
#include "oort/map/tuning.hpp"

namespace oort {
namespace {

using Defect = std::optional<std::string>;

std::string number(std::uint64_t value) {
  return std::to_string(value);
}

Defect check_covariance(const Eigen::Matrix3d& covariance, const std::string& owner) {
  const auto defect = find_covariance_defect(covariance);
  return defect ? Defect("the covariance of " + owner + " " + *defect) : std::nullopt;
}

/// Of a pose, or of how two lie to each other.
Defect check_pose(const Pose2& pose, const std::string& owner) {
  if (!is_finite(pose)) return "the pose of " + owner + " is not finite";
  const double most = std::max({std::abs(pose.x), std::abs(pose.y), std::abs(pose.theta)});
  if (most > 2.0 * MapTuning::kMaxCoordinate) return "the pose of " + owner + " is more than 100 km off";
  return std::nullopt;
}

Defect check_size(const Map& map) {
  const auto exceeds = [](std::uint64_t count, std::uint64_t most, const std::string& what) -> Defect {
    if (count <= most) return std::nullopt;
    return "it has " + number(count) + " " + what + ", and a map can hold " + number(most);
  };
  std::uint64_t points = 0;
  for (const PointCloud& cloud : map.clouds) points += cloud.points.size();
  for (const auto& [count, most, what] :
       {std::tuple{map.graph.nodes.size(), MapTuning::kMaxNodes, "nodes"},
        std::tuple{map.graph.edges.size(), MapTuning::kMaxEdges, "edges"},
        std::tuple{map.graph.switchable_edges.size(), MapTuning::kMaxEdges, "switchable edges"},
        std::tuple{map.incremental_results.size(), MapTuning::kMaxEdges, "incremental results"},
        std::tuple{map.loop_results.size(), MapTuning::kMaxEdges, "loop results"},
        std::tuple{map.locations.size(), MapTuning::kMaxLocations, "locations"},
        std::tuple{points, MapTuning::kMaxPoints, "points"}}) {
    if (auto defect = exceeds(count, most, what)) return defect;
  }
  return std::nullopt;
}

Defect check_nodes(const Map& map) {
  for (std::size_t k = 0; k < map.graph.nodes.size(); ++k) {
    const Node& node = map.graph.nodes[k];
    if (node.id != k) return "node " + number(k) + " has the id " + number(node.id);
    if (auto defect = check_pose(node.pose, "node " + number(k))) return defect;
  }
  return std::nullopt;
}

/// Of an edge of either kind.
template <typename AnyEdge>
Defect check_edge(const AnyEdge& edge, std::size_t node_count) {
  const std::string name = "edge " + number(edge.id);
  if (edge.id == std::numeric_limits<std::uint64_t>::max()) return name + " leaves no id for the edges to come";
  for (const std::uint64_t id : {edge.i, edge.j, edge.constraint.id}) {
    if (id >= node_count) {
      return name + " refers to node " + number(id) + ", but there are " + number(node_count) + " nodes";
    }
  }
  if (edge.i == edge.j) return name + " links node " + number(edge.i) + " to itself";
  if (auto defect = check_pose(edge.constraint.T_i_j, name)) return defect;
  if (!std::isfinite(edge.constraint.time)) return "the time of " + name + " is not finite";
  return check_covariance(edge.constraint.covariance, name);
}

Defect check_edges(const Map& map) {
  const std::size_t node_count = map.graph.nodes.size();
  for (const Edge& edge : map.graph.edges) {
    if (auto defect = check_edge(edge, node_count)) return defect;
  }
  for (const SwitchableEdge& edge : map.graph.switchable_edges) {
    if (auto defect = check_edge(edge, node_count)) return defect;
    if (!(edge.switch_value >= 0.0 && edge.switch_value <= 1.0)) {
      return "the switch of edge " + number(edge.id) + " is " + std::to_string(edge.switch_value) + ", outside [0, 1]";
    }
  }
  return std::nullopt;
}

Defect check_clouds(const Map& map) {
  if (map.clouds.size() != map.graph.nodes.size()) {
    return "there are " + number(map.graph.nodes.size()) + " nodes but " + number(map.clouds.size()) + " clouds";
  }
  for (std::size_t k = 0; k < map.clouds.size(); ++k) {
    const PointCloud& cloud = map.clouds[k];
    if (cloud.id != k) return "cloud " + number(k) + " belongs to node " + number(cloud.id);
    if (!std::isfinite(cloud.time)) return "the time of cloud " + number(k) + " is not finite";
    for (const Point2& point : cloud.points) {
      if (!std::isfinite(point.y) || (point.is_return() && !std::isfinite(point.x))) {
        return "a point of cloud " + number(k) + " is not finite though it counts as a return or a bearing";
      }
      if (point.is_return() && std::hypot(point.x, point.y) > GeometryTuning::kMaxRange) {
        return "a return of cloud " + number(k) + " is farther off than a laser can see";
      }
    }
  }
  return std::nullopt;
}

/// Of an IncrementalResult or a LoopResult.
template <typename Result>
Defect check_result(const Result& result, const std::string& name, std::size_t node_count) {
  for (const std::uint64_t id : {result.id, result.target}) {
    if (id >= node_count) {
      return name + " refers to node " + number(id) + ", but there are " + number(node_count) + " nodes";
    }
  }
  if (!std::isfinite(result.inlier_ratio)) return "the inlier ratio of " + name + " is not finite";
  // How well it was matched is told and kept, and no match rests on it: the published maps are loose with it.
  if (!result.covariance.allFinite()) return "the covariance of " + name + " is not finite";
  if ((result.covariance.diagonal().array() < 0.0).any()) {
    return "the covariance of " + name + " has a negative variance";
  }
  return std::nullopt;
}

Defect check_results(const Map& map) {
  const std::size_t node_count = map.graph.nodes.size();
  for (std::size_t k = 0; k < map.incremental_results.size(); ++k) {
    const IncrementalResult& result = map.incremental_results[k];
    const std::string name = "incremental result " + number(k);
    if (auto defect = check_result(result, name, node_count)) return defect;
    for (const Pose2& pose : {result.T_local_id, result.T_target_id}) {
      if (auto defect = check_pose(pose, name)) return defect;
    }
  }
  for (std::size_t k = 0; k < map.loop_results.size(); ++k) {
    const LoopResult& result = map.loop_results[k];
    const std::string name = "loop result " + number(k);
    if (auto defect = check_result(result, name, node_count)) return defect;
    if (auto defect = check_pose(result.T_id_target, name)) return defect;
  }
  return std::nullopt;
}

Defect check_name(const Location& location) {
  for (const std::string& text : {location.name_space, location.id}) {
    if (text.find('\0') != std::string::npos) return "a location's name holds a NUL character";
    if (text.size() > MapTuning::kMaxNameLength) {
      return "a location's name is longer than " + number(MapTuning::kMaxNameLength) + " bytes";
    }
  }
  return std::nullopt;
}

Defect check_locations(const Map& map) {
  for (const Location& location : map.locations) {
    const std::string name = "location '" + location.name_space + "/" + location.id + "'";
    if (location.node_id >= map.graph.nodes.size()) {
      return name + " refers to node " + number(location.node_id) + ", but there are " +
             number(map.graph.nodes.size()) + " nodes";
    }
    if (auto defect = check_pose(location.T_node_location, name)) return defect;
    if (auto defect = check_name(location)) return defect;
  }
  return std::nullopt;
}

}  // namespace

Defect find_defect(const Map& map) {
  for (const auto check : {check_size, check_nodes, check_edges, check_clouds, check_results, check_locations}) {
    if (auto defect = check(map)) return defect;
  }
  return std::nullopt;
}

void check_reach(const Pose2& pose, const std::string& what, const std::string& advice) {
  const double most = std::max({std::abs(pose.x), std::abs(pose.y), std::abs(pose.theta)});
  if (!is_finite(pose) || most > MapTuning::kMaxCoordinate) {
    throw InputError(what + " is not finite, or more than 16,000 turns or 100 km off; " + advice);
  }
}

}  // namespace oort
