// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/view_selection.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "oort/graph/graph_check.hpp"
#include "oort/maintenance/lifelong_tuning.hpp"
#include "oort/maintenance/tied_segments.hpp"

namespace oort {
namespace {

/// A piece of surface and the side it is seen from, or a place of the floor and a heading.
using Key = std::tuple<std::uint64_t, long, long, unsigned>;  // part of the map, cell, side

unsigned sector_of(double angle, unsigned count) {
  const double turns = (angle + M_PI) / (2.0 * M_PI);  // headings of a loaded map may lie beyond a turn
  return static_cast<unsigned>((turns - std::floor(turns)) * count) % count;
}

Key key_of(std::uint64_t part, const Eigen::Vector2d& point, double cell, double angle, unsigned sectors) {
  return {part, std::lround(std::floor(point.x() / cell)), std::lround(std::floor(point.y() / cell)),
          sector_of(angle, sectors)};
}

std::vector<Key> shown_by(const PointCloud& cloud, const Pose2& pose, std::uint64_t part) {
  std::vector<Key> keys;
  const Eigen::Matrix2d R = rotation(pose.theta);
  for (const Point2& point : cloud.points) {
    if (!point.is_return()) continue;
    const Eigen::Vector2d beam = R * Eigen::Vector2d(point.x, point.y);
    keys.push_back(key_of(part, pose.translation() + beam, LifelongTuning::kSurfaceCell, std::atan2(beam.y(), beam.x()),
                          LifelongTuning::kSides));
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

std::vector<bool> must_stay(const Map& map) {
  std::vector<bool> stays = find_anchors(map.graph);
  std::vector<bool> has_earlier(stays.size(), false);
  for (const Edge& edge : map.graph.edges) has_earlier[std::max(edge.i, edge.j)] = true;
  for (std::size_t k = 0; k < stays.size(); ++k) stays[k] = stays[k] || !has_earlier[k];
  for (const Location& location : map.locations) stays[location.node_id] = true;
  for (const SwitchableEdge& edge : map.graph.switchable_edges) {
    if (edge.i < edge.j) stays[edge.i] = true;  // a dock's node
  }
  return stays;
}

}  // namespace

std::vector<bool> select_views(const Map& map, const TrajectorySegments& segments, unsigned views,
                               std::uint64_t newest) {
  const std::size_t size = map.graph.nodes.size();
  std::vector<bool> kept = must_stay(map);
  const std::vector<std::uint64_t> parts = tied_parts(map.graph, segments);
  std::map<Key, unsigned> surfaces, places;
  const auto look = [&](std::uint64_t node) {
    const Pose2& pose = map.graph.nodes[node].pose;
    const std::vector<Key> shown = shown_by(map.clouds[node], pose, parts[node]);
    unsigned& here = places[key_of(parts[node], pose.translation(), LifelongTuning::kPlaceCell, pose.theta,
                                   LifelongTuning::kHeadings)];
    const auto rare = static_cast<std::size_t>(
        std::count_if(shown.begin(), shown.end(), [&](const Key& key) { return surfaces[key] < views; }));
    const bool tells = rare >= LifelongTuning::kMinNewCells &&
                       static_cast<double>(rare) >= LifelongTuning::kMinNewShare * static_cast<double>(shown.size());
    if (!kept[node] && !tells && here > 0) return;
    kept[node] = true;
    ++here;
    for (const Key& key : shown) ++surfaces[key];
  };
  std::vector<std::uint64_t> order(size);
  std::iota(order.begin(), order.end(), std::uint64_t{0});
  const auto rank = [&](std::uint64_t node) { return kept[node] ? 0 : segments.is_matched(node) ? 1 : 2; };
  std::vector<int> ranks(size);
  for (std::uint64_t node = 0; node < size; ++node) ranks[node] = rank(node);
  std::stable_sort(order.begin(), order.end(), [&](std::uint64_t a, std::uint64_t b) { return ranks[a] < ranks[b]; });
  for (const std::uint64_t node : order) look(node);
  for (std::uint64_t node = size - std::min<std::uint64_t>(newest, size); node < size; ++node) kept[node] = true;
  return kept;
}

}  // namespace oort
