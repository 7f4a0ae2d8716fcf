// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/tied_segments.hpp"

#include "oort/map/parts.hpp"
#include "oort/map/tuning.hpp"

namespace oort {

namespace {

std::vector<std::uint64_t> parts_of(const Graph& graph, const TrajectorySegments& segments, double max_deviation) {
  std::vector<std::uint64_t> parts(graph.nodes.size());
  for (std::uint64_t node = 0; node < parts.size(); ++node) parts[node] = segments.segment_begin(node);
  join_parts(graph, max_deviation, parts);
  return parts;
}

}  // namespace

std::vector<std::uint64_t> tied_parts(const Graph& graph, const TrajectorySegments& segments) {
  return parts_of(graph, segments, MapTuning::kMaxWalkDeviation);
}

std::vector<std::uint64_t> closed_parts(const Graph& graph, const TrajectorySegments& segments) {
  return parts_of(graph, segments, 0.0);
}

}  // namespace oort
