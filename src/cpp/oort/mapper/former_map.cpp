// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/former_map.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "oort/maintenance/tied_segments.hpp"
#include "oort/mapper/tuning.hpp"

namespace oort {
namespace {

/// A flag for each node: whether it is in the largest part of the map.
std::vector<bool> largest_part(const Graph& graph, const TrajectorySegments& segments) {
  const std::vector<std::uint64_t> parts = tied_parts(graph, segments);
  std::vector<std::size_t> sizes(parts.size(), 0);
  for (const std::uint64_t part : parts) ++sizes[part];
  const auto largest = static_cast<std::uint64_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  std::vector<bool> nodes;
  nodes.reserve(parts.size());
  for (const std::uint64_t part : parts) nodes.push_back(part == largest);
  return nodes;
}

template <typename AnyEdge>
std::vector<AnyEdge> edges_before(const std::vector<AnyEdge>& edges, std::uint64_t size) {
  std::vector<AnyEdge> chosen;
  for (const AnyEdge& edge : edges) {
    if (std::max(edge.i, edge.j) < size) chosen.push_back(edge);
  }
  return chosen;
}

Graph graph_before(const Graph& graph, std::uint64_t size) {
  return {{graph.nodes.begin(), graph.nodes.begin() + static_cast<std::ptrdiff_t>(size)},
          edges_before(graph.edges, size),
          edges_before(graph.switchable_edges, size)};
}

/// The rigid motion that brings points closest to others (Horn 1987, in the plane).
Pose2 rigid_motion(const std::vector<Eigen::Vector2d>& from, const std::vector<Eigen::Vector2d>& to) {
  Eigen::Vector2d mean_from = Eigen::Vector2d::Zero(), mean_to = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < from.size(); ++k) {
    mean_from += from[k] / static_cast<double>(from.size());
    mean_to += to[k] / static_cast<double>(from.size());
  }
  double along = 0.0, across = 0.0;
  for (std::size_t k = 0; k < from.size(); ++k) {
    const Eigen::Vector2d a = from[k] - mean_from, b = to[k] - mean_to;
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
  }
  const double angle = std::atan2(across, along);
  const Eigen::Vector2d shift = mean_to - rotation(angle) * mean_from;
  return {shift.x(), shift.y(), angle};
}

}  // namespace

FormerMap::FormerMap(const Map& map, const TrajectorySegments& segments, std::uint64_t size,
                     const OptimizerOptions& options) {
  if (size == 0) return;
  Graph graph = graph_before(map.graph, size);
  nodes_ = largest_part(graph, segments);
  for (const Node& node : graph.nodes) poses_.push_back(node.pose);
  optimize(graph, options);
  for (const Node& node : graph.nodes) solved_.push_back(node.pose);
}

bool FormerMap::keeps_shape(const Graph& solved) const {
  std::vector<Eigen::Vector2d> alone, now;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    if (!nodes_[k]) continue;
    alone.push_back(solved_[k].translation());
    now.push_back(solved.nodes[k].pose.translation());
  }
  const Pose2 motion = rigid_motion(alone, now);
  std::size_t moved = 0;
  for (std::size_t k = 0; k < alone.size(); ++k) {
    if ((now[k] - motion * alone[k]).norm() > MapperTuning::kMaxDeformed) ++moved;
  }
  return static_cast<double>(moved) <= MapperTuning::kMaxDeformedShare * static_cast<double>(alone.size());
}

void FormerMap::restore(Graph& graph) const {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    if (nodes_[k]) graph.nodes[k].pose = poses_[k];
  }
}

SwitchedOff switched_off(const Graph& one, const Graph& other, std::uint64_t first_new) {
  SwitchedOff count;
  for (std::size_t k = 0; k < one.switchable_edges.size(); ++k) {
    const SwitchableEdge& edge = one.switchable_edges[k];
    if (std::max(edge.i, edge.j) < first_new || !edge.is_on()) continue;
    ++count.of;
    if (!other.switchable_edges[k].is_on()) ++count.off;
  }
  return count;
}

}  // namespace oort
