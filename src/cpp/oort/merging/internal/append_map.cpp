// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/merging/internal/append_map.hpp"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace oort {
namespace {

/// An edge of either kind with the ids of the other map's nodes and edges counted on from these.
template <typename AnyEdge>
AnyEdge renumbered(AnyEdge edge, std::uint64_t first_node, std::uint64_t first_edge) {
  edge.id += first_edge;
  edge.i += first_node;
  edge.j += first_node;
  edge.constraint.id += first_node;
  return edge;
}

/// Of an IncrementalResult or a LoopResult.
template <typename Result>
Result renumbered(Result result, std::uint64_t first_node) {
  result.id += first_node;
  result.target += first_node;
  return result;
}

/// Bit by bit: what is no return holds numbers that are not equal to themselves.
bool same_number(double a, double b) {
  return std::memcmp(&a, &b, sizeof(double)) == 0;
}

bool same_scan(const PointCloud& a, const PointCloud& b) {
  return a.points.size() == b.points.size() &&
         std::equal(a.points.begin(), a.points.end(), b.points.begin(), [](const Point2& p, const Point2& q) {
           return same_number(p.x, q.x) && same_number(p.y, q.y) && same_number(p.z, q.z);
         });
}

std::vector<const PointCloud*> by_time(const Map& map) {
  std::vector<const PointCloud*> clouds;
  for (const PointCloud& cloud : map.clouds) clouds.push_back(&cloud);
  std::stable_sort(clouds.begin(), clouds.end(),
                   [](const PointCloud* a, const PointCloud* b) { return a->time < b->time; });
  return clouds;
}

}  // namespace

std::uint64_t append_map(const Map& other, const Pose2& T_map_other, Map& map) {
  const std::uint64_t first_node = map.graph.nodes.size();
  const std::uint64_t first_edge = next_edge_id(map.graph);
  for (const Node& node : other.graph.nodes) map.graph.nodes.push_back({node.id + first_node, T_map_other * node.pose});
  for (PointCloud cloud : other.clouds) {
    cloud.id += first_node;
    map.clouds.push_back(std::move(cloud));
  }
  for (const Edge& edge : other.graph.edges) {
    map.graph.edges.push_back(renumbered(edge, first_node, first_edge));
  }
  for (const SwitchableEdge& edge : other.graph.switchable_edges) {
    map.graph.switchable_edges.push_back(renumbered(edge, first_node, first_edge));
  }
  for (const IncrementalResult& result : other.incremental_results) {
    map.incremental_results.push_back(renumbered(result, first_node));
  }
  for (const LoopResult& result : other.loop_results) map.loop_results.push_back(renumbered(result, first_node));
  for (Location location : other.locations) {
    location.node_id += first_node;
    map.locations.push_back(std::move(location));
  }
  return first_node;
}

std::uint64_t count_common_scans(const Map& a, const Map& b) {
  const std::vector<const PointCloud*> clouds_a = by_time(a);
  std::uint64_t common = 0;
  for (const PointCloud* cloud : by_time(b)) {
    if (count_returns(*cloud) == 0) continue;  // scans that saw nothing are all alike
    const auto from = std::lower_bound(clouds_a.begin(), clouds_a.end(), cloud->time,
                                       [](const PointCloud* other, double time) { return other->time < time; });
    for (auto other = from; other != clouds_a.end() && (*other)->time == cloud->time; ++other) {
      if (!same_scan(**other, *cloud)) continue;
      ++common;
      break;
    }
  }
  return common;
}

}  // namespace oort
