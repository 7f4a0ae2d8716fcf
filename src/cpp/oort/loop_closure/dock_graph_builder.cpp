// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/dock_graph_builder.hpp"

#include <algorithm>

#include "oort/loop_closure/submaps.hpp"
#include "oort/loop_closure/tuning.hpp"
#include "oort/matching/frsm_adapter.hpp"
#include "oort/matching/frsm_setup.hpp"

namespace oort {
namespace {

/// Whether matches of fewer nodes than documented are tried.
bool has_fallback(const DockGraphBuilderParameters& p) {
  return p.dock_match_least_size < p.dock_match_submap_size;
}

/// Fewer nodes fit somewhere else, too, the sooner the fewer they are: as many misses are allowed less.
double needed_inlier_ratio(const DockGraphBuilderParameters& p, std::size_t query_nodes) {
  if (!has_fallback(p)) return p.dock_match_min_hit_pct;
  const double share = static_cast<double>(query_nodes) / p.dock_match_submap_size;
  return p.dock_match_min_hit_pct + (1.0 - share) * (1.0 - p.dock_match_min_hit_pct);
}

/// The first of the nodes up to the query that may not stand for the dock. The way back would match itself, however
/// bent: twice as many nodes as are matched are left out, or the later half of a short drive.
std::uint64_t first_of_the_way_back(const DockGraphBuilderParameters& p, std::uint64_t dock, std::uint64_t query,
                                    std::size_t query_nodes) {
  std::uint64_t apart = static_cast<std::uint64_t>(query_nodes);
  if (has_fallback(p)) {
    const std::uint64_t half = query > dock ? (query - dock + 1) / 2 : 0;
    apart = std::max(apart, std::min<std::uint64_t>(2 * static_cast<std::uint64_t>(p.dock_match_submap_size), half));
  }
  return query + 1 - std::min(apart, query + 1);
}

/// Up to `size` nodes around the dock, none from `way_back` to `query`: its node and those after it, then those before.
std::vector<PlacedNode> reference_nodes(const Map& map, const TrajectorySegments& segments, std::uint64_t dock,
                                        std::size_t size, std::uint64_t way_back, std::uint64_t query) {
  std::vector<PlacedNode> nodes;
  const auto take = [&](const PlacedNode& placed) {
    if (nodes.size() < size && (placed.node < way_back || placed.node > query)) nodes.push_back(placed);
  };
  for (const PlacedNode& placed : walk_trajectory(map, segments, dock, Direction::kForward, size)) take(placed);
  const std::vector<PlacedNode> before = walk_trajectory(map, segments, dock, Direction::kBackward, size);
  std::for_each(before.begin() + 1, before.end(), take);  // the dock's own node was taken
  return nodes;
}

/// What is seen from some nodes, in the frame of what they are seen from.
frsm::Points points_of(const Map& map, const std::vector<PlacedNode>& nodes) {
  frsm::Points points;
  for (const PlacedNode& placed : nodes) {
    append_transformed(returns_of(map.clouds[placed.node]), placed.T_origin_node, points);
  }
  return points;
}

}  // namespace

DockPlace nearest_dock(const Map& map, const TrajectorySegments& segments, std::uint64_t query) {
  const Pose2& here = map.graph.nodes[query].pose;
  DockPlace nearest{segments.segment_begin(query), Pose2{}};
  double nearest_distance = -1.0;
  for (const Location& location : map.locations) {
    if (location.name_space != "dock") continue;
    const Pose2 T_map_dock = map.graph.nodes[location.node_id].pose * location.T_node_location;
    const double distance = (T_map_dock.translation() - here.translation()).norm();
    if (nearest_distance < 0.0 || distance < nearest_distance) {
      nearest_distance = distance;
      nearest = {location.node_id, location.T_node_location};
    }
  }
  return nearest;
}

void make_dock_closures_firm(Map& map, double firmness) {
  for (SwitchableEdge& edge : map.graph.switchable_edges) {
    if (edge.i > edge.j) continue;
    const auto matched_it = [&edge](const LoopResult& result) {
      return result.id == edge.i && result.target == edge.j && result.inlier_ratio > 0.0;
    };
    if (std::any_of(map.loop_results.begin(), map.loop_results.end(), matched_it)) edge.firmness = firmness;
  }
}

DockGraphBuilder::DockGraphBuilder(const Parameters& parameters)
    : parameters_(parameters.dock_graph_builder),
      table_(table_params(parameters.incremental_graph_builder.frsm_matcher)),
      contours_(frsm::ContourParams::urg()),
      matcher_(matcher_params(parameters.incremental_graph_builder.frsm_matcher)),
      error_(match_error(parameters.incremental_graph_builder.frsm_matcher)) {}

std::optional<Closure> DockGraphBuilder::find(const Map& map, const TrajectorySegments& segments, std::uint64_t query,
                                              ClosureCounts& counts, WorkMeter* meter) const {
  ++counts.tried;
  const DockPlace dock = nearest_dock(map, segments, query);
  Rejection rejection = Rejection::kNone;
  std::optional<Closure> closure;
  if (dock.node == query) {
    rejection = Rejection::kSameNode;
  } else {
    const auto least = static_cast<std::size_t>(parameters_.dock_match_least_size);
    const auto most = static_cast<std::size_t>(parameters_.dock_match_submap_size);
    std::size_t size = walk_trajectory(map, segments, query, Direction::kBackward, most).size();
    closure = match(map, segments, query, dock, size, rejection, meter);
    for (size /= 2; !closure && size >= least; size /= 2) {
      Rejection later = Rejection::kNone;  // what the documented number of nodes says is what counts
      closure = match(map, segments, query, dock, size, later, meter);
      if (closure && closure->inlier_ratio == 0.0) closure.reset();  // but more nodes did see something
    }
  }
  if (closure) {
    ++counts.accepted;
  } else {
    ++counts.rejected[rejection];
  }
  return closure;
}

std::optional<Closure> DockGraphBuilder::match(const Map& map, const TrajectorySegments& segments, std::uint64_t query,
                                               const DockPlace& dock, std::size_t query_size, Rejection& rejection,
                                               WorkMeter* meter) const {
  const std::vector<PlacedNode> query_nodes = walk_trajectory(map, segments, query, Direction::kBackward, query_size);
  const std::uint64_t way_back = first_of_the_way_back(parameters_, dock.node, query, query_size);
  const std::vector<PlacedNode> reference = reference_nodes(
      map, segments, dock.node, static_cast<std::size_t>(parameters_.dock_submap_size), way_back, query);
  if (reference.empty()) {
    rejection = Rejection::kNoReference;
    return std::nullopt;
  }

  // The robot touches the contacts somewhere along their size, and the dock may have been moved.
  const double reach = std::max(parameters_.dock_contacts_size + parameters_.dock_max_translation, table_.cell);
  const Eigen::Vector3d limits(reach, reach, parameters_.search_window_theta);
  const double sigmas =
      parameters_.closure_firmness > 1.0 ? LoopClosureTuning::kReachSigmas : 1.0;  // 1 is what is documented
  const frsm::Prior prior{to_frsm(dock.T_node_dock), (limits / sigmas).cwiseAbs2().asDiagonal()};
  const frsm::Points points = points_of(map, query_nodes);
  charge(meter, static_cast<double>(reference.size()) * work_of_drawing(map.clouds[dock.node], table_.radius) +
                    LoopClosureTuning::kFrsmWorkPerPoint * static_cast<double>(points.size()));
  const auto submap = draw_submap(map, reference, table_, contours_);
  const auto on_lookups = [meter](std::uint64_t lookups) {
    charge(meter, LoopClosureTuning::kFrsmWorkPerLookup * static_cast<double>(lookups));
  };
  const frsm::Match match =
      matcher_.match(*submap, points, prior.mean, {reach, reach, parameters_.search_window_theta}, &prior, on_lookups);
  const Pose2 T_dock_query = from_frsm(match.pose);
  if (match.status == frsm::Status::kTooFewPoints || match.status == frsm::Status::kEmptyScan) {
    // Nothing was seen that could speak against the contacts: the robot is at the dock, give or take their reach.
    return Closure{dock.node, query, dock.T_node_dock, prior.covariance, 0.0};
  }
  if (match.hits == 0) {
    rejection = Rejection::kNoHits;
  } else if (match.inlier_ratio < needed_inlier_ratio(parameters_, query_size)) {
    rejection = Rejection::kHits;
  } else if (between(dock.T_node_dock, T_dock_query).translation().norm() > parameters_.dock_match_max_dist) {
    rejection = Rejection::kDistance;
  } else {
    Eigen::Matrix3d covariance = match.covariance + error_;
    if (parameters_.closure_firmness > 1.0) {  // what can hardly be doubted must be honest
      covariance += Eigen::Vector3d(LoopClosureTuning::kDockSigma, LoopClosureTuning::kDockSigma,
                                    LoopClosureTuning::kDockSigmaTheta)
                        .cwiseAbs2()
                        .asDiagonal();
    }
    return Closure{dock.node, query, T_dock_query, covariance, match.inlier_ratio, parameters_.closure_firmness};
  }
  return std::nullopt;
}

}  // namespace oort
