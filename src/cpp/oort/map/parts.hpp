// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/graph/graph.hpp"
#include "oort/map/map.hpp"

namespace oort {

/// Joins nodes that edges of less than a standard deviation [m] of x and y hold together, or closures that are on.
/// `parts`: for each node the part that it belongs to, by the part's first node.
void join_parts(const Graph& graph, double max_deviation, std::vector<std::uint64_t>& parts);

/// A map whose nodes may be in several parts, of which nothing tells how they lie to one another: after a pause, in a
/// session, or after a kidnapping, as long as no closure ties what follows.
struct MapParts {
  std::vector<std::uint64_t> main;                ///< nodes of the part with a dock, else of the largest
  std::vector<std::vector<std::uint64_t>> loose;  ///< nodes of each other part, in the order of their first nodes
};

MapParts parts_of(const Map& map);

}  // namespace oort
