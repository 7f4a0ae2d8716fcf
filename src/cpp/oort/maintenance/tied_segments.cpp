// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/tied_segments.hpp"

#include <algorithm>

#include "oort/map/tuning.hpp"

namespace oort {
namespace {

bool ties(const Constraint& constraint) {
  return std::max(constraint.covariance(0, 0), constraint.covariance(1, 1)) <
         MapTuning::kMaxWalkDeviation * MapTuning::kMaxWalkDeviation;
}

}  // namespace

std::vector<std::uint64_t> tied_parts(const Graph& graph, const TrajectorySegments& segments) {
  std::vector<std::uint64_t> part(graph.nodes.size());
  for (std::uint64_t node = 0; node < part.size(); ++node) part[node] = segments.segment_begin(node);
  const auto root = [&part](std::uint64_t node) {
    while (part[node] != node) node = part[node] = part[part[node]];
    return node;
  };
  const auto join = [&](std::uint64_t i, std::uint64_t j) {
    const std::uint64_t a = root(i), b = root(j);
    part[std::max(a, b)] = std::min(a, b);
  };
  for (const Edge& edge : graph.edges) {
    if (ties(edge.constraint)) join(edge.i, edge.j);
  }
  for (const SwitchableEdge& edge : graph.switchable_edges) {
    if (edge.is_on()) join(edge.i, edge.j);
  }
  for (std::uint64_t node = 0; node < part.size(); ++node) part[node] = root(node);
  return part;
}

}  // namespace oort
