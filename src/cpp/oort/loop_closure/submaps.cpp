// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/submaps.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "oort/loop_closure/tuning.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {

namespace {

/// Draws scans, at poses in the frame of the table.
void draw_scans(const Map& map, const std::vector<PlacedNode>& nodes, const frsm::ContourParams& contours,
                frsm::Table& table) {
  struct Scan {
    frsm::Points body, world;
    frsm::Pose pose;
  };
  std::vector<Scan> scans;
  Eigen::AlignedBox2d box;
  for (const PlacedNode& placed : nodes) {
    if (placed.T_origin_node.translation().norm() > LoopClosureTuning::kMaxSubmapReach) continue;
    const frsm::Pose pose = to_frsm(placed.T_origin_node);
    frsm::Points body = returns_of(map.clouds[placed.node]);
    frsm::Points world = frsm::transform(pose, body);
    for (const frsm::Point& p : frsm::transform(pose, frsm::within(body, table.params().radius))) {
      box.extend(Eigen::Vector2d(p.x, p.y));
    }
    scans.push_back({std::move(body), std::move(world), pose});
  }
  if (box.isEmpty()) return;
  table.reserve({box.min().x(), box.min().y()}, {box.max().x(), box.max().y()});
  for (const Scan& scan : scans) table.draw(scan.world, frsm::extract_contours(scan.body, contours), scan.pose);
}

}  // namespace

double work_of_drawing(const PointCloud& cloud, double reach) {
  const frsm::Points points = frsm::within(returns_of(cloud), reach);
  double length = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const double step = std::hypot(points[k].x - points[k - 1].x, points[k].y - points[k - 1].y);
    length += std::min(step, LoopClosureTuning::kLongestLine);
  }
  return LoopClosureTuning::kFrsmWorkPerDrawn * static_cast<double>(points.size()) +
         LoopClosureTuning::kFrsmWorkPerMetre * length;
}

std::shared_ptr<const frsm::Table> draw_submap(const Map& map, const std::vector<PlacedNode>& nodes,
                                               const frsm::TableParams& table, const frsm::ContourParams& contours) {
  auto drawn = std::make_shared<frsm::Table>(table);
  draw_scans(map, nodes, contours, *drawn);
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
            std::vector<PlacedNode> placed;
            for (std::size_t k = drawn; k < nodes.size(); ++k) {
              placed.push_back({nodes[k], between(segments.local_pose(node), segments.local_pose(nodes[k]))});
            }
            draw_scans(map, placed, contours, *drawing);
            return drawing;
          }};
}

}  // namespace oort
