// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/graph.hpp"

#include <algorithm>

namespace oort {

std::uint64_t next_edge_id(const Graph& graph) {
  std::uint64_t next = 0;
  for (const Edge& edge : graph.edges) next = std::max(next, edge.id + 1);
  for (const SwitchableEdge& edge : graph.switchable_edges) next = std::max(next, edge.id + 1);
  return next;
}

}  // namespace oort
