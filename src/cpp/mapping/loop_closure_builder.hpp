// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <frsm/matcher.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oort/graph/graph.hpp"
#include "oort/mapping/chains.hpp"
#include "oort/mapping/map.hpp"
#include "oort/mapping/statistics.hpp"
#include "oort/mapping/submaps.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// A relative pose found between two nodes that odometry did not link.
struct Closure {
  std::uint64_t from = 0;
  std::uint64_t to = 0;
  Pose2 T_from_to;
  Eigen::Matrix3d covariance;  ///< along the axes of node `from`
  double hit_fraction = 0.0;
};

/// Looks for places seen before and measures where the newest node stands in their submaps (REQUIREMENTS O-86, O-87).
class LoopClosureBuilder {
 public:
  explicit LoopClosureBuilder(const Parameters& parameters);

  /// The closures of one node, which is the `from` of each. Counts every attempt.
  std::vector<Closure> find(const Map& map, const Chains& chains, std::uint64_t query, ClosureCounts& counts);

  /// Nodes worth matching against, nearest first: at most knearest_neighbors, none within the neighbourhood of another
  /// or of the query.
  std::vector<std::uint64_t> candidates(const Map& map, const Chains& chains, std::uint64_t query) const;

 private:
  std::vector<std::uint64_t> nearest(const std::vector<std::pair<double, std::uint64_t>>& by_distance,
                                     const Chains& chains, std::uint64_t query, int id_threshold) const;
  /// Sets `reason` when there is no closure.
  std::optional<Closure> match(const Map& map, const Chains& chains, std::uint64_t query,
                               const frsm::Points& query_points, std::uint64_t candidate, std::string& reason);

  LoopClosureGraphBuilderParameters parameters_;
  frsm::TableParams table_;
  SubmapCache submaps_;
  frsm::Matcher matcher_;
};

}  // namespace oort
