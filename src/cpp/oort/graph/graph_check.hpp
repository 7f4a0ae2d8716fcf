// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
// Internal to the optimiser.
#include <optional>
#include <string>
#include <vector>

#include "oort/graph/graph.hpp"

namespace oort {

/// InputError, naming the node or edge, if the graph cannot be solved: ids that do not count up from 0, a number that
/// is not finite, an edge to a node that does not exist or to itself, a switch outside 0 to 1.
void check_graph(const Graph& graph);

/// Why the optimiser cannot use a covariance, in words that follow "it"; nothing if it can: it must be finite,
/// symmetric and positive definite, with standard deviations between 1e-12 and 1e6 (m, rad).
std::optional<std::string> find_covariance_defect(const Eigen::Matrix3d& covariance);

/// One flag per node: true for the first node of each connected part. Without it the part could float freely.
std::vector<bool> find_anchors(const Graph& graph);

template <typename AnyEdge>
std::string describe(const AnyEdge& edge) {
  return "edge " + std::to_string(edge.id) + " (node " + std::to_string(edge.i) + " to " + std::to_string(edge.j) + ")";
}

}  // namespace oort
