// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/tied_segments.hpp"

#include "oort/map/parts.hpp"
#include "oort/map/tuning.hpp"

namespace oort {

std::vector<std::uint64_t> tied_parts(const Graph& graph, const TrajectorySegments& segments) {
  std::vector<std::uint64_t> parts(graph.nodes.size());
  for (std::uint64_t node = 0; node < parts.size(); ++node) parts[node] = segments.segment_begin(node);
  join_parts(graph, MapTuning::kMaxWalkDeviation, parts);
  return parts;
}

}  // namespace oort
