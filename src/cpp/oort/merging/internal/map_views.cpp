// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/merging/internal/map_views.hpp"

#include <algorithm>
#include <limits>

namespace oort {
namespace {

MapView view_of(const Map& map, const TrajectorySegments& segments, std::uint64_t node, std::uint64_t size) {
  MapView view;
  view.node = node;
  const std::vector<std::uint64_t> nodes = segments.neighborhood(node, size);
  view.T_map_sensor = map.graph.nodes[nodes.back()].pose;
  for (const std::uint64_t other : nodes) view.scans.push_back({map.clouds[other], segments.local_pose(other)});
  return view;
}

}  // namespace

std::vector<MapView> spread_views(const Map& map, const TrajectorySegments& segments, std::size_t max_views,
                                  double spacing, std::uint64_t nodes) {
  std::vector<MapView> views;
  std::vector<double> distance(map.graph.nodes.size(), std::numeric_limits<double>::infinity());  // to any view
  for (std::uint64_t node = 0; node < distance.size(); ++node) {
    if (!segments.is_matched(node)) distance[node] = -1.0;
  }
  while (views.size() < max_views) {
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (farthest == distance.end() || *farthest < spacing) break;
    const auto node = static_cast<std::uint64_t>(farthest - distance.begin());
    views.push_back(view_of(map, segments, node, nodes));
    for (const Node& other : map.graph.nodes) {
      const double apart = (other.pose.translation() - map.graph.nodes[node].pose.translation()).norm();
      distance[other.id] = std::min(distance[other.id], apart);
    }
  }
  return views;
}

}  // namespace oort
