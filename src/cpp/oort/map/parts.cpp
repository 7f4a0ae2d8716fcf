// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/map/parts.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "oort/map/tuning.hpp"

namespace oort {

void join_parts(const Graph& graph, double max_deviation, std::vector<std::uint64_t>& parts) {
  const auto root = [&parts](std::uint64_t node) {
    while (parts[node] != node) node = parts[node] = parts[parts[node]];
    return node;
  };
  const auto join = [&](std::uint64_t i, std::uint64_t j) {
    const std::uint64_t a = root(i), b = root(j);
    parts[std::max(a, b)] = std::min(a, b);
  };
  for (const Edge& edge : graph.edges) {
    const Eigen::Matrix3d& covariance = edge.constraint.covariance;
    if (std::max(covariance(0, 0), covariance(1, 1)) < max_deviation * max_deviation) join(edge.i, edge.j);
  }
  for (const SwitchableEdge& edge : graph.switchable_edges) {
    if (edge.is_on()) join(edge.i, edge.j);
  }
  for (std::uint64_t node = 0; node < parts.size(); ++node) parts[node] = root(node);
}

MapParts parts_of(const Map& map) {
  std::vector<std::uint64_t> parts(map.graph.nodes.size());
  std::iota(parts.begin(), parts.end(), std::uint64_t{0});
  join_parts(map.graph, MapTuning::kMaxPlacedDeviation, parts);
  std::vector<std::vector<std::uint64_t>> nodes(parts.size());  // by a part's first node
  for (std::uint64_t node = 0; node < parts.size(); ++node) nodes[parts[node]].push_back(node);
  std::vector<bool> has_dock(parts.size(), false);
  for (const Location& location : map.locations) {
    if (location.name_space == "dock") has_dock[parts[location.node_id]] = true;
  }
  const auto rank = [&](std::uint64_t part) { return std::pair(bool(has_dock[part]), nodes[part].size()); };
  std::uint64_t main = 0;
  for (std::uint64_t part = 1; part < parts.size(); ++part) {
    if (rank(part) > rank(main)) main = part;
  }
  MapParts result;
  for (std::uint64_t part = 0; part < parts.size(); ++part) {
    if (part == main) {
      result.main = std::move(nodes[part]);
    } else if (!nodes[part].empty()) {
      result.loose.push_back(std::move(nodes[part]));
    }
  }
  return result;
}

}  // namespace oort
