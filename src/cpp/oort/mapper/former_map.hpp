// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/geometry/pose2.hpp"
#include "oort/graph/optimizer.hpp"
#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"

namespace oort {

/// The map that a session goes on with, and when it stays as it is (docs/lifelong.md). Each session's measurements err
/// by a centimetre or so; were they to move what is there, all places would wander from day to day.
class FormerMap {
 public:
  FormerMap() = default;

  /// The nodes before `size`, where they lie now: those of the largest part that closures or the trajectory tie, as
  /// nothing tells where others lie to it. Solves their graph, to know what it makes of them by itself.
  FormerMap(const Map& map, const TrajectorySegments& segments, std::uint64_t size, const OptimizerOptions& options);

  /// A flag for each node before `size`: whether it is one of those that may stay.
  const std::vector<bool>& nodes() const { return nodes_; }

  /// Whether a solution of the whole graph leaves the map in shape: it deforms no good part of it by more than it may
  /// be wrong anyway. Turning or shifting it as a whole counts for nothing.
  bool keeps_shape(const Graph& solved) const;

  /// Puts its nodes back.
  void restore(Graph& graph) const;

 private:
  std::vector<bool> nodes_;
  std::vector<Pose2> poses_;   // of all nodes, as they were
  std::vector<Pose2> solved_;  // the same at the optimum of their own graph, which a refined map is not at
};

/// Closures of nodes from `first_new` on that are on in one graph and off in the same graph solved otherwise.
struct SwitchedOff {
  std::size_t off = 0;
  std::size_t of = 0;  ///< closures that are on in the one
};
SwitchedOff switched_off(const Graph& one, const Graph& other, std::uint64_t first_new);

}  // namespace oort
