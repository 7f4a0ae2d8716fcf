// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/geometry/pose2.hpp"
#include "oort/map/map.hpp"

namespace oort {

/// The trajectory segments of a map. Within a segment the poses in the scan matcher's own frame are trusted to be
/// rigid, so submaps are made from them: they do not change when the graph is solved. Nodes that only odometry placed
/// join no submap. A new segment begins with each session, after each pause, and wherever the edge to the node before
/// is very uncertain.
class TrajectorySegments {
 public:
  /// Adds the next node: `T_local_sensor` is its pose in the scan matcher's frame of its segment, `matched` whether the
  /// scan matcher saw it there.
  void add(bool begins_segment, bool matched, const Pose2& T_local_sensor);

  /// From this node on its segment is another one.
  void split(std::uint64_t node);

  /// Recovers the segments of a map from its edges and incremental results.
  static TrajectorySegments of_map(const Map& map);

  std::size_t size() const { return local_poses_.size(); }
  bool is_matched(std::uint64_t node) const { return matched_[node]; }
  const Pose2& local_pose(std::uint64_t node) const { return local_poses_[node]; }
  bool same_segment(std::uint64_t a, std::uint64_t b) const { return first_[a] == first_[b]; }
  std::uint64_t segment_begin(std::uint64_t node) const { return first_[node]; }
  std::uint64_t segment_end(std::uint64_t node) const;  ///< one past the last node of the node's segment

  /// How many nodes at the usual spacing lead from one node to the other: where nodes are counted for the way between
  /// them, those that are farther apart (scans are rare) count as several.
  std::uint64_t travel_between(std::uint64_t a, std::uint64_t b) const;
  /// Whether the node is the first of its segment, or the first of another `stride` of such nodes since then.
  bool begins_stride(std::uint64_t node, std::uint64_t stride) const;

  /// The matched ones among up to `size` nodes at the usual spacing of the node's segment with the node in their
  /// middle, in the order of their ids, and the node itself.
  std::vector<std::uint64_t> neighborhood(std::uint64_t node, std::uint64_t size) const;

 private:
  std::vector<std::uint64_t> first_;  ///< per node: the first node of its segment
  std::vector<bool> matched_;
  std::vector<Pose2> local_poses_;
  std::vector<std::uint64_t> travel_;  ///< per node: nodes at the usual spacing before it
};

}  // namespace oort
