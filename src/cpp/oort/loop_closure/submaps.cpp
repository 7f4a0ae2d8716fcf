// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/submaps.hpp"

#include <algorithm>
#include <cmath>

#include "oort/loop_closure/tuning.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {

namespace {

void draw_scan(const Map& map, const PlacedNode& placed, const frsm::ContourParams& contours, frsm::Table& table) {
  if (placed.T_origin_node.translation().norm() > LoopClosureTuning::kMaxSubmapReach) return;
  const frsm::Pose T_origin_node = to_frsm(placed.T_origin_node);
  const frsm::Points points = returns_of(map.clouds[placed.node]);
  table.draw(frsm::transform(T_origin_node, points), frsm::extract_contours(points, contours), T_origin_node);
}

}  // namespace

std::shared_ptr<const frsm::Table> draw_submap(const Map& map, const std::vector<PlacedNode>& nodes,
                                               const frsm::TableParams& table, const frsm::ContourParams& contours) {
  auto drawn = std::make_shared<frsm::Table>(table);
  for (const PlacedNode& placed : nodes) draw_scan(map, placed, contours, *drawn);
  return drawn;
}

frsm::Points gather_points(const Map& map, const TrajectorySegments& segments, std::uint64_t origin,
                           const std::vector<std::uint64_t>& nodes, double reach) {
  frsm::Points points;
  for (const std::uint64_t node : nodes) {
    frsm::Points seen = returns_of(map.clouds[node]);
    seen.erase(std::remove_if(seen.begin(), seen.end(),
                              [reach](const frsm::Point& p) { return std::hypot(p.x, p.y) > reach; }),
               seen.end());
    append_transformed(seen, between(segments.local_pose(origin), segments.local_pose(node)), points);
  }
  return points;
}

SubmapCache<frsm::Table> table_cache(std::uint64_t neighborhood_size, std::size_t max_bytes,
                                     const frsm::TableParams& table, const frsm::ContourParams& contours) {
  return {neighborhood_size, max_bytes,
          [table, contours](const Map& map, const TrajectorySegments& segments, std::uint64_t node,
                            const std::vector<std::uint64_t>& nodes, std::size_t drawn,
                            const std::shared_ptr<frsm::Table>& so_far) {
            auto drawing = drawn > 0 ? so_far : std::make_shared<frsm::Table>(table);
            for (std::size_t k = drawn; k < nodes.size(); ++k) {
              const Pose2 T_origin_node = between(segments.local_pose(node), segments.local_pose(nodes[k]));
              draw_scan(map, {nodes[k], T_origin_node}, contours, *drawing);
            }
            return drawing;
          }};
}

}  // namespace oort
