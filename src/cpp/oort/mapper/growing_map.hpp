// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "oort/loop_closure/closure.hpp"
#include "oort/map/map.hpp"
#include "oort/map/node_addition.hpp"
#include "oort/map/node_range.hpp"
#include "oort/map/renumbering.hpp"
#include "oort/map/trajectory_segments.hpp"

namespace oort {

/// Where a solved graph has its nodes, and what it makes of its switchable edges: those that were there, in their
/// order.
struct Solution {
  std::vector<Pose2> poses;
  std::vector<double> switches;
};

/// A map with its trajectory segments, that grows by nodes and is corrected by closures and solutions. Each lane has
/// one of its own: the same additions in the same order make the same map.
class GrowingMap {
 public:
  const Map& map() const { return map_; }
  const TrajectorySegments& segments() const { return segments_; }
  std::uint64_t node_count() const { return map_.graph.nodes.size(); }

  /// Replaces everything. The map must be one that find_defect() accepts.
  void set_map(Map map);

  /// Replaces the nodes that were reduced by what is left of them. Those that came since, and places, go over to it.
  void reduce(const Map& reduced, const Renumbering& nodes);

  /// Adds a node at where the present poses and its placement put it.
  void add(const NodeAddition& addition);

  /// Adds a switchable edge. Returns its squared Mahalanobis distance from the present poses.
  double add(const Closure& closure);

  /// Takes out the closures that tie the nodes to others, but for firm ones.
  void withdraw_ties(const std::vector<NodeRange>& nodes);

  /// From this node on its trajectory segment is another one.
  void begin_segment(std::uint64_t node) { segments_.split(node); }

  /// Nothing is known any more of where the nodes lie but what closures say.
  void loosen(const std::vector<NodeRange>& nodes);

  /// Takes over the poses and switches of a solution. Nodes that it does not know yet follow the ones they were placed
  /// from.
  void apply(const Solution& solution);
  Solution solution() const;

  /// For those who change poses, switches or places; nodes and edges are added above.
  Map& edit() { return map_; }

 private:
  /// Where a node is relative to an earlier one, until a solution knows it.
  struct Placement {
    std::optional<std::uint64_t> from;
    Pose2 T_from_node;
  };

  Map map_;
  TrajectorySegments segments_;
  std::vector<Placement> placements_;  // of the newest nodes: those that were not loaded
  std::uint64_t next_edge_id_ = 0;
};

}  // namespace oort
