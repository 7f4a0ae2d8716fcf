// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "oort/map/map.hpp"
#include "oort/map/renumbering.hpp"
#include "oort/map/trajectory_segments.hpp"

namespace oort {

/// A map without the nodes that show nothing more than others.
struct Pruned {
  Map map;
  Renumbering nodes;
};

struct PruneOptions {
  unsigned views = 3;        ///< of a piece of surface from one side that are kept
  double min_share = 0.0;    ///< of the nodes: nothing is done for less, nor for a few
  std::uint64_t newest = 0;  ///< nodes that stay whatever they show: where they lie may not be known well yet
};

/// Reduces a map to the views that it needs (select_views()). What the edges of the nodes that go knew is folded into
/// edges between those that stay: along the trajectory their covariances are compounded, and closures are carried to
/// the nearest node of their trajectory (docs/lifelong.md). Nothing becomes more certain than it was. Poses, places and
/// docks stay where they are; closures that were switched off go with their nodes, and none is switched on.
///
/// The map must be one that find_defect() accepts. Nothing if there is nothing to prune. The same map gives the same
/// bits.
std::optional<Pruned> prune(const Map& map, const PruneOptions& options);
/// The same where the segments are known.
std::optional<Pruned> prune(const Map& map, const TrajectorySegments& segments, const PruneOptions& options);

/// The same of a map that grew over many sessions, all at once; first, what newer segments contradict is taken out of
/// older ones (remove_outdated()).
Pruned prune_grown(Map map, unsigned views);

}  // namespace oort
