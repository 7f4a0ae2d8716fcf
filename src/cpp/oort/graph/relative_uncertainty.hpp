// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "oort/graph/graph.hpp"

namespace oort {

/// How well a graph knows where its nodes are as seen from one of them: the covariance that adds up along the best
/// known path of edges. The truth is at most that, since other paths tell more.
class RelativeUncertainty {
 public:
  /// Takes the edges that were added since the last call, and begins anew if there are fewer than before.
  void update(const Graph& graph);

  /// Covariance of T_from_node (x, y, theta, along the axes of the map) for each node, at the graph's present poses;
  /// none for nodes that no path leads to. An edge that is more off than on leads nowhere.
  std::vector<std::optional<Eigen::Matrix3d>> from(const Graph& graph, std::uint64_t from) const;

 private:
  struct Incidence {
    std::uint64_t to;
    std::uint64_t edge;
    bool switchable;
  };
  std::vector<std::vector<Incidence>> incident_;  // edges, by node
  std::size_t edges_ = 0;
  std::size_t switchable_edges_ = 0;
};

}  // namespace oort
