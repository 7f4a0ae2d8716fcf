// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/growing_map.hpp"

#include <algorithm>
#include <utility>

#include "oort/mapper/tuning.hpp"

namespace oort {
namespace {

/// Between nodes that are far apart in time now their edges tell, as for a map that is loaded. The newest, which all
/// stayed, go on in the scan matcher's frame, as a segment of their own.
TrajectorySegments reduced_segments(const TrajectorySegments& before, const Map& reduced, const Renumbering& nodes) {
  const std::uint64_t size = nodes.carrier.size();
  const std::uint64_t newest = size - std::min<std::uint64_t>(MapperTuning::kUnsettledNodes, size);
  const TrajectorySegments of_map = TrajectorySegments::of_map(reduced);
  TrajectorySegments segments;
  for (std::uint64_t node = 0; node < nodes.of(newest); ++node) {
    segments.add(of_map.segment_begin(node) == node, of_map.is_matched(node), of_map.local_pose(node));
  }
  for (std::uint64_t node = newest; node < before.size(); ++node) {
    segments.add(node == newest || before.segment_begin(node) == node, before.is_matched(node),
                 before.local_pose(node));
  }
  return segments;
}

bool leads_out(const std::vector<NodeRange>& nodes, std::uint64_t i, std::uint64_t j) {
  return contains(nodes, i) != contains(nodes, j);
}

}  // namespace

void GrowingMap::set_map(Map map) {
  map_ = std::move(map);
  segments_ = TrajectorySegments::of_map(map_);
  placements_.clear();
  next_edge_id_ = next_edge_id(map_.graph);
}

void GrowingMap::reduce(const Map& reduced, const Renumbering& nodes) {
  const std::uint64_t first_newer = nodes.carrier.size();
  const std::uint64_t first_placed = node_count() - placements_.size();
  const Map before = std::exchange(map_, reduced);
  segments_ = reduced_segments(segments_, reduced, nodes);
  map_.locations.clear();
  for (const Location& location : before.locations) map_.locations.push_back(renumbered(location, nodes));
  next_edge_id_ = next_edge_id(map_.graph);
  std::vector<Placement> placements;
  for (std::uint64_t node = first_newer; node < before.graph.nodes.size(); ++node) {
    Placement placement = placements_[node - first_placed];
    if (placement.from) placement.from = nodes.of(*placement.from);
    const Pose2 pose =
        placement.from ? map_.graph.nodes[*placement.from].pose * placement.T_from_node : before.graph.nodes[node].pose;
    map_.graph.nodes.push_back({nodes.of(node), pose});
    PointCloud cloud = before.clouds[node];
    cloud.id = nodes.of(node);
    map_.clouds.push_back(std::move(cloud));
    placements.push_back(placement);
  }
  placements_ = std::move(placements);
  for (Edge edge : before.graph.edges) {
    if (std::max(edge.i, edge.j) < first_newer) continue;
    edge = renumbered(edge, nodes);
    edge.id = next_edge_id_++;
    map_.graph.edges.push_back(edge);
  }
  for (const IncrementalResult& result : before.incremental_results) {
    if (result.id >= first_newer) map_.incremental_results.push_back(renumbered(result, nodes));
  }
}

void GrowingMap::add(const NodeAddition& addition) {
  Node node;
  node.id = node_count();
  node.pose = addition.from ? map_.graph.nodes[*addition.from].pose * addition.T_from_node : addition.T_from_node;
  map_.graph.nodes.push_back(node);
  for (Edge edge : addition.edges) {
    edge.id = next_edge_id_++;
    map_.graph.edges.push_back(edge);
  }
  segments_.add(addition.begins_segment, addition.matched, addition.result.T_local_id);
  map_.clouds.push_back(addition.cloud);
  map_.incremental_results.push_back(addition.result);
  placements_.push_back({addition.from, addition.T_from_node});
}

double GrowingMap::add(const Closure& closure) {
  return add_closure(closure, next_edge_id_++, map_);
}

void GrowingMap::withdraw_ties(const std::vector<NodeRange>& nodes) {
  std::vector<SwitchableEdge>& edges = map_.graph.switchable_edges;
  std::vector<LoopResult>& results = map_.loop_results;
  const auto is_tie = [&](const SwitchableEdge& edge) {
    return edge.firmness <= 1.0 && leads_out(nodes, edge.i, edge.j);
  };
  for (const SwitchableEdge& edge : edges) {
    if (!is_tie(edge)) continue;
    const auto of_edge = [&](const LoopResult& result) { return result.id == edge.i && result.target == edge.j; };
    results.erase(std::remove_if(results.begin(), results.end(), of_edge), results.end());
  }
  edges.erase(std::remove_if(edges.begin(), edges.end(), is_tie), edges.end());
}

void GrowingMap::loosen(const std::vector<NodeRange>& nodes) {
  const Eigen::Vector3d sigma(MapperTuning::kLooseSigma, MapperTuning::kLooseSigma, MapperTuning::kLooseSigma);
  for (Edge& edge : map_.graph.edges) {
    if (leads_out(nodes, edge.i, edge.j)) edge.constraint.covariance = sigma.cwiseAbs2().asDiagonal();
  }
}

void GrowingMap::apply(const Solution& solution) {
  std::vector<Node>& nodes = map_.graph.nodes;
  for (std::size_t k = 0; k < solution.poses.size(); ++k) nodes[k].pose = solution.poses[k];
  const std::size_t first_placed = nodes.size() - placements_.size();
  for (std::size_t k = solution.poses.size(); k < nodes.size(); ++k) {
    const Placement& placement = placements_[k - first_placed];
    if (placement.from) nodes[k].pose = nodes[*placement.from].pose * placement.T_from_node;
  }
  for (std::size_t k = 0; k < solution.switches.size(); ++k) {
    map_.graph.switchable_edges[k].switch_value = solution.switches[k];
  }
}

Solution GrowingMap::solution() const {
  Solution solution;
  solution.poses.reserve(map_.graph.nodes.size());
  solution.switches.reserve(map_.graph.switchable_edges.size());
  for (const Node& node : map_.graph.nodes) solution.poses.push_back(node.pose);
  for (const SwitchableEdge& edge : map_.graph.switchable_edges) solution.switches.push_back(edge.switch_value);
  return solution;
}

}  // namespace oort
