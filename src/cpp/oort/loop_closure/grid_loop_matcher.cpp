// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/grid_loop_matcher.hpp"

#include <limits>
#include <utility>

#include "oort/grid/range_data.hpp"
#include "oort/grid/voxel_filter.hpp"
#include "oort/loop_closure/submaps.hpp"
#include "oort/loop_closure/tuning.hpp"
#include "oort/matching/ceres_matcher.hpp"
#include "oort/matching/fast_correlative_matcher.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

/// Bounds are those of a whole grid: one that grows is drawn anew.
SubmapCache<BoundGrids> grid_cache(const BranchAndBoundMatcherParameters& p, const LoopScale& scale) {
  const ProbabilityGridParameters grid = p.probability_grid;
  const int depth = p.fast_correlative_scan_matcher.branch_and_bound_depth;
  const double reach = scale.reach;
  return {scale.submap_nodes, LoopClosureTuning::kSubmapCacheBytes,
          [grid, depth, reach](const Map& map, const TrajectorySegments& segments, std::uint64_t node,
                               const std::vector<std::uint64_t>& nodes, std::size_t /*drawn*/,
                               const std::shared_ptr<BoundGrids>& /*so_far*/) {
            return std::make_shared<BoundGrids>(draw_grid(map, segments, node, nodes, grid, reach), depth);
          }};
}

}  // namespace

ProbabilityGrid draw_grid(const Map& map, const TrajectorySegments& segments, std::uint64_t origin,
                          const std::vector<std::uint64_t>& nodes, const ProbabilityGridParameters& parameters,
                          double reach) {
  struct Seen {
    Eigen::Vector2d sensor;
    std::vector<BeamEnd> ends;
  };
  std::vector<Seen> all;
  Eigen::AlignedBox2d box;
  for (const std::uint64_t node : nodes) {
    const Pose2 T_origin_node = between(segments.local_pose(origin), segments.local_pose(node));
    Seen seen{T_origin_node.translation(), {}};
    box.extend(seen.sensor);
    for (const Eigen::Vector2d& point : to_points(returns_of(map.clouds[node]))) {
      if (point.norm() > reach) continue;
      seen.ends.push_back({T_origin_node * point, true});
      box.extend(seen.ends.back().point);
    }
    all.push_back(std::move(seen));
  }
  ProbabilityGrid grid(GridLimits::enclosing(box, parameters.resolution));
  const BeamInserter inserter(parameters);
  for (const Seen& seen : all) inserter.insert_growing(seen.sensor, seen.ends, grid);
  return grid;
}

GridLoopMatcher::GridLoopMatcher(const Parameters& parameters, const LoopScale& scale)
    : parameters_(parameters.loop_closure_graph_builder.branch_and_bound_matcher),
      scale_(scale),
      submaps_(grid_cache(parameters_, scale)) {}

bool GridLoopMatcher::is_small(const TrajectorySegments& segments, std::uint64_t candidate) const {
  return segments.neighborhood(candidate, scale_.submap_nodes).size() <=
         static_cast<std::size_t>(parameters_.submap_min_neighborhood_size);
}

bool GridLoopMatcher::draw(const Map& map, const TrajectorySegments& segments, std::uint64_t candidate,
                           WorkMeter* meter) {
  charge(meter, LoopClosureTuning::kGridWorkPerDrawn *
                    static_cast<double>(scale_.submap_nodes * map.clouds[candidate].points.size()));
  return !is_small(segments, candidate) &&
         submaps_.draw(map, segments, candidate, std::numeric_limits<std::size_t>::max());
}

LoopMatcher::Found GridLoopMatcher::find(const Map& map, const TrajectorySegments& segments, std::uint64_t query,
                                         std::uint64_t candidate, const SearchWindow& window, WorkMeter* meter) {
  const Pose2 expected = between(map.graph.nodes[candidate].pose, map.graph.nodes[query].pose);
  const auto rejected = [&](Rejection rejection) { return Found{expected, Eigen::Matrix3d::Zero(), 0.0, rejection}; };
  if (is_small(segments, candidate)) return rejected(Rejection::kSmallSubmap);
  const Points points = adaptive_voxel_filter(
      to_points(gather_points(map, segments, query, segments.neighborhood(query, scale_.query_nodes), scale_.reach)),
      parameters_.adaptive_voxel_filter);
  charge(meter, LoopClosureTuning::kGridWorkPerMatch +
                    LoopClosureTuning::kGridWorkPerTurn * static_cast<double>(points.size()) * window.theta);
  const std::shared_ptr<const BoundGrids> submap = submaps_.get(map, segments, candidate);
  const ScanMatch rough =
      FastCorrelativeMatcher(submap, {window.xy, window.theta, parameters_.min_score}).match(points, expected);
  if (!rough.usable()) return rejected(rough.rejection);
  const ScanMatch fine = CeresMatcher(submap->grid(), parameters_.ceres_scan_matcher).match(points, rough.pose);
  return {fine.pose, fine.covariance + scale_.bend(), fine.inlier_ratio, Rejection::kNone};
}

}  // namespace oort
