// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/prune.hpp"

#include <algorithm>
#include <utility>

#include "oort/maintenance/lifelong_tuning.hpp"
#include "oort/maintenance/outdated.hpp"
#include "oort/maintenance/reduced_graph.hpp"
#include "oort/maintenance/view_selection.hpp"
#include "oort/map/trajectory_segments.hpp"

namespace oort {
namespace {

bool is_worth_it(std::size_t pruned, std::size_t size, const PruneOptions& options) {
  if (options.min_share == 0.0) return pruned > 0;
  return pruned >= LifelongTuning::kMinPruned &&
         static_cast<double>(pruned) >= options.min_share * static_cast<double>(size);
}

/// A node's result on what the trajectory says of it now.
IncrementalResult renumbered(IncrementalResult result, const ReducedGraph& reduced) {
  const std::uint64_t node = result.id;
  result.id = reduced.new_id[node];
  result.target = reduced.new_id[reduced.parent[node]];
  if (reduced.parent[node] != node) result.T_target_id = reduced.T_parent_node[node];
  return result;
}

}  // namespace

std::optional<Pruned> prune(const Map& map, const PruneOptions& options) {
  return prune(map, TrajectorySegments::of_map(map), options);
}

std::optional<Pruned> prune(const Map& map, const TrajectorySegments& segments, const PruneOptions& options) {
  const std::vector<bool> kept = select_views(map, segments, options.views, options.newest);
  const auto pruned = static_cast<std::size_t>(std::count(kept.begin(), kept.end(), false));
  if (!is_worth_it(pruned, kept.size(), options)) return std::nullopt;
  const ReducedGraph reduced = reduce(map, segments, kept);
  Pruned result;
  result.map.graph = reduced.graph;
  result.map.loop_results = reduced.loop_results;
  result.nodes = {kept, reduced.carrier, {}, reduced.graph.nodes.size()};
  for (std::uint64_t node = 0; node < kept.size(); ++node) {
    const Pose2& T_map_carrier = reduced.graph.nodes[reduced.carrier[node]].pose;
    result.nodes.T_carrier_node.push_back(kept[node] ? Pose2{} : between(T_map_carrier, map.graph.nodes[node].pose));
    if (!kept[node]) continue;
    PointCloud cloud = map.clouds[node];
    cloud.id = reduced.new_id[node];
    result.map.clouds.push_back(std::move(cloud));
  }
  for (const IncrementalResult& old : map.incremental_results) {
    if (kept[old.id]) result.map.incremental_results.push_back(renumbered(old, reduced));
  }
  for (const Location& location : map.locations) result.map.locations.push_back(renumbered(location, result.nodes));
  return result;
}

Pruned prune_grown(Map map, unsigned views) {
  const TrajectorySegments segments = TrajectorySegments::of_map(map);
  for (std::uint64_t node = 1; node < segments.size(); ++node) {
    const bool begins = segments.segment_begin(node) == node;
    if (begins && segments.segment_end(node) - node >= LifelongTuning::kMinWitnesses) {
      remove_outdated(map, segments, node);
    }
  }
  std::optional<Pruned> pruned = prune(map, {views});
  if (pruned) return std::move(*pruned);
  Renumbering same = Renumbering::none(segments.size());
  return {std::move(map), std::move(same)};
}

}  // namespace oort
