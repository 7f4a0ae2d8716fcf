// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/map/trajectory_walk.hpp"

#include <algorithm>
#include <optional>

#include "oort/map/tuning.hpp"

namespace oort {
namespace {

/// What the trajectory says of the node `id + 1` as seen from `id`.
std::optional<Pose2> step_after(const Map& map, const TrajectorySegments& segments, std::uint64_t id) {
  if (segments.same_segment(id, id + 1)) return between(segments.local_pose(id), segments.local_pose(id + 1));
  for (const Edge& edge : map.graph.edges) {
    if (edge.i != id || edge.j != id + 1) continue;
    const Eigen::Matrix3d& covariance = edge.constraint.covariance;
    if (std::max(covariance(0, 0), covariance(1, 1)) > MapTuning::kMaxWalkDeviation * MapTuning::kMaxWalkDeviation) {
      return std::nullopt;
    }
    return edge.constraint.T_i_j;
  }
  return std::nullopt;
}

}  // namespace

std::vector<PlacedNode> walk_trajectory(const Map& map, const TrajectorySegments& segments, std::uint64_t origin,
                                        Direction direction, std::size_t count) {
  std::vector<PlacedNode> nodes{{origin, Pose2{}}};
  while (nodes.size() < count) {
    const auto [node, T_origin_node] = nodes.back();
    const bool forward = direction == Direction::kForward;
    if (forward ? node + 1 >= segments.size() : node == 0) break;
    const std::optional<Pose2> step = step_after(map, segments, forward ? node : node - 1);
    if (!step) break;
    nodes.push_back(forward ? PlacedNode{node + 1, T_origin_node * *step}
                            : PlacedNode{node - 1, T_origin_node * inverse(*step)});
  }
  return nodes;
}

}  // namespace oort
