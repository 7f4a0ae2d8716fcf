// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/graph_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "oort/geometry/errors.hpp"
#include "oort/graph/internal/residuals.hpp"
#include "oort/graph/tuning.hpp"

namespace oort {
namespace {

void check_nodes(const std::vector<Node>& nodes) {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (nodes[k].id != k) {
      throw InputError("node ids must count up from 0: found node " + std::to_string(nodes[k].id) + " at position " +
                       std::to_string(k));
    }
    if (!is_finite(nodes[k].pose)) throw InputError("the pose of node " + std::to_string(k) + " is not finite");
  }
}

template <typename AnyEdge>
void check_edge(const AnyEdge& edge, std::size_t node_count) {
  for (const std::uint64_t end : {edge.i, edge.j}) {
    if (end >= node_count) {
      throw InputError(describe(edge) + " names a node that is not in the graph, which has " +
                       std::to_string(node_count) + " nodes");
    }
  }
  if (edge.i == edge.j) throw InputError(describe(edge) + " links a node to itself");
  if (!is_finite(edge.constraint.T_i_j)) throw InputError("the measurement of " + describe(edge) + " is not finite");
}

}  // namespace

void check_graph(const Graph& graph) {
  check_nodes(graph.nodes);
  for (const Edge& edge : graph.edges) check_edge(edge, graph.nodes.size());
  for (const SwitchableEdge& edge : graph.switchable_edges) {
    check_edge(edge, graph.nodes.size());
    if (!(edge.switch_value >= 0.0 && edge.switch_value <= 1.0)) {
      throw InputError("the switch of " + describe(edge) + " is " + std::to_string(edge.switch_value) +
                       ", outside 0 to 1");
    }
    if (!(edge.firmness >= 1.0 && std::isfinite(edge.firmness))) {
      throw InputError("the firmness of " + describe(edge) + " is " + std::to_string(edge.firmness) +
                       ", not finite and at least 1");
    }
  }
}

std::optional<std::string> find_covariance_defect(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return "is not finite";
  if ((covariance.diagonal().array() < 0.0).any()) return "has a negative variance";
  if (covariance.cwiseAbs().maxCoeff() > GraphTuning::kMaxVariance) return "is larger than any that was measured";
  try {
    const Eigen::Matrix3d whitening = whitening_matrix(covariance, Whitening::kCorrect);
    if (whitening.cwiseAbs().maxCoeff() > GraphTuning::kMaxWeight) return "is smaller than any that was measured";
  } catch (const InputError& error) {
    const std::string text = error.what();  // "covariance is ..."
    return text.substr(text.find(' ') + 1);
  }
  return std::nullopt;
}

std::vector<bool> find_anchors(const Graph& graph) {
  std::vector<std::size_t> parent(graph.nodes.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&parent](std::size_t k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  const auto join = [&parent, &root](std::size_t i, std::size_t j) {
    const auto [first, second] = std::minmax({root(i), root(j)});
    parent[second] = first;  // the root of a part is its first node
  };
  for (const Edge& edge : graph.edges) join(edge.i, edge.j);
  for (const SwitchableEdge& edge : graph.switchable_edges) join(edge.i, edge.j);

  std::vector<bool> anchors(graph.nodes.size());
  for (std::size_t k = 0; k < anchors.size(); ++k) anchors[k] = root(k) == k;
  return anchors;
}

}  // namespace oort
