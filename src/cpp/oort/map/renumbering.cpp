// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/map/renumbering.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

namespace oort {

Renumbering Renumbering::none(std::uint64_t size) {
  Renumbering same{std::vector<bool>(size, true), std::vector<std::uint64_t>(size), std::vector<Pose2>(size), size};
  std::iota(same.carrier.begin(), same.carrier.end(), std::uint64_t{0});
  return same;
}

std::uint64_t Renumbering::left_before(std::uint64_t node) const {
  if (node >= kept.size()) return of(node);
  return static_cast<std::uint64_t>(std::count(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(node), true));
}

Renumbering operator*(const Renumbering& first, const Renumbering& second) {
  Renumbering both;
  // The second may know of nodes that came after the first.
  const std::size_t size = first.carrier.size() + second.carrier.size() - first.size;
  for (std::uint64_t node = 0; node < size; ++node) {
    const bool is_old = node < first.carrier.size();
    const std::uint64_t between = first.of(node);
    both.kept.push_back((!is_old || first.kept[node]) && second.kept[between]);
    both.carrier.push_back(second.of(between));
    both.T_carrier_node.push_back(second.T_carrier_node[between] * (is_old ? first.T_carrier_node[node] : Pose2{}));
  }
  both.size = second.size;
  return both;
}

Location renumbered(Location location, const Renumbering& nodes) {
  if (location.node_id < nodes.carrier.size() && !nodes.kept[location.node_id]) {
    location.T_node_location = nodes.T_carrier_node[location.node_id] * location.T_node_location;
  }
  location.node_id = nodes.of(location.node_id);
  return location;
}

Edge renumbered(Edge edge, const Renumbering& nodes) {
  edge.i = nodes.of(edge.i);
  edge.j = nodes.of(edge.j);
  edge.constraint.id = nodes.of(edge.constraint.id);
  return edge;
}

IncrementalResult renumbered(IncrementalResult result, const Renumbering& nodes) {
  result.id = nodes.of(result.id);
  result.target = nodes.of(result.target);
  return result;
}

NodeAddition renumbered(NodeAddition addition, const Renumbering& nodes) {
  PointCloud cloud = *addition.cloud;
  cloud.id = nodes.of(cloud.id);
  addition.cloud = std::make_shared<const PointCloud>(std::move(cloud));
  if (addition.from) addition.from = nodes.of(*addition.from);
  for (Edge& edge : addition.edges) edge = renumbered(edge, nodes);
  addition.result = renumbered(addition.result, nodes);
  return addition;
}

}  // namespace oort
