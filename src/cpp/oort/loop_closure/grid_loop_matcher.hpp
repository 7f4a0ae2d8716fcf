// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "oort/loop_closure/loop_matcher.hpp"
#include "oort/loop_closure/submap_cache.hpp"
#include "oort/matching/bound_grids.hpp"

namespace oort {

/// As Cartographer does: the scan, thinned, is searched for in a probability grid of the submap by branch and bound,
/// then refined on the same grid (loop_closure_graph_builder.branch_and_bound_matcher).
class GridLoopMatcher : public LoopMatcher {
 public:
  GridLoopMatcher(const Parameters& parameters, const LoopScale& scale);

  Found find(const Map& map, const TrajectorySegments& segments, std::uint64_t query, std::uint64_t candidate,
             const SearchWindow& window, WorkMeter* meter = nullptr) override;
  /// Draws all of it.
  bool draw(const Map& map, const TrajectorySegments& segments, std::uint64_t candidate,
            WorkMeter* meter = nullptr) override;

 private:
  bool is_small(const TrajectorySegments& segments, std::uint64_t candidate) const;

  BranchAndBoundMatcherParameters parameters_;
  LoopScale scale_;
  SubmapCache<BoundGrids> submaps_;
};

/// The scans of some nodes of one segment as a probability grid, in the frame of `origin`, a node of that segment.
/// Returns farther than `reach` [m] from where they were seen are left out.
ProbabilityGrid draw_grid(const Map& map, const TrajectorySegments& segments, std::uint64_t origin,
                          const std::vector<std::uint64_t>& nodes, const ProbabilityGridParameters& parameters,
                          double reach);

}  // namespace oort
