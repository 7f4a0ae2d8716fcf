// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/map/map_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "oort/geometry/errors.hpp"
#include "oort/map/tuning.hpp"

namespace oort {
namespace {

using Defect = std::optional<std::string>;

std::string number(std::uint64_t value) {
  return std::to_string(value);
}

Defect check_covariance(const Eigen::Matrix3d& covariance, const std::string& owner) {
  if (!covariance.allFinite()) return "the covariance of " + owner + " is not finite";
  if ((covariance.diagonal().array() < 0.0).any()) return "the covariance of " + owner + " has a negative variance";
  return std::nullopt;
}

Defect check_nodes(const Map& map) {
  for (std::size_t k = 0; k < map.graph.nodes.size(); ++k) {
    const Node& node = map.graph.nodes[k];
    if (node.id != k) return "node " + number(k) + " has the id " + number(node.id);
    if (!is_finite(node.pose)) return "the pose of node " + number(k) + " is not finite";
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
  if (!is_finite(edge.constraint.T_i_j)) return "the pose of " + name + " is not finite";
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
  return check_covariance(result.covariance, name);
}

Defect check_results(const Map& map) {
  const std::size_t node_count = map.graph.nodes.size();
  for (std::size_t k = 0; k < map.incremental_results.size(); ++k) {
    const IncrementalResult& result = map.incremental_results[k];
    const std::string name = "incremental result " + number(k);
    if (auto defect = check_result(result, name, node_count)) return defect;
    if (!is_finite(result.T_local_id) || !is_finite(result.T_target_id)) return "a pose of " + name + " is not finite";
  }
  for (std::size_t k = 0; k < map.loop_results.size(); ++k) {
    const LoopResult& result = map.loop_results[k];
    const std::string name = "loop result " + number(k);
    if (auto defect = check_result(result, name, node_count)) return defect;
    if (!is_finite(result.T_id_target)) return "the pose of " + name + " is not finite";
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
    if (!is_finite(location.T_node_location)) return "the pose of " + name + " is not finite";
  }
  return std::nullopt;
}

}  // namespace

Defect find_defect(const Map& map) {
  for (const auto check : {check_nodes, check_edges, check_clouds, check_results, check_locations}) {
    if (auto defect = check(map)) return defect;
  }
  return std::nullopt;
}

void check_reach(const Pose2& pose, const std::string& what, const std::string& advice) {
  if (!is_finite(pose) || std::max(std::abs(pose.x), std::abs(pose.y)) > MapTuning::kMaxCoordinate) {
    throw InputError(what + " is not finite or more than 100 km off; " + advice);
  }
}

}  // namespace oort
