// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oort/graph/relative_uncertainty.hpp"
#include "oort/mapping/chains.hpp"
#include "oort/mapping/closure.hpp"
#include "oort/mapping/closure_confirmation.hpp"
#include "oort/mapping/loop_matcher.hpp"
#include "oort/mapping/map.hpp"
#include "oort/mapping/statistics.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// Looks for places seen before and measures where the newest node stands in their submaps (REQUIREMENTS O-86, O-87).
///
/// How far it looks follows from how well the graph knows where the newest node is, as seen from the candidate. Where
/// that is well, one scan is matched. Where it is not, one scan of a short-range sensor looks like too many places: the
/// last metres of the way are matched together, and what would move the newest node far waits until it is confirmed.
class LoopClosureBuilder {
 public:
  explicit LoopClosureBuilder(const Parameters& parameters);

  /// The closures that are believed now that the newest node, `query`, is there. Counts every attempt.
  std::vector<Closure> find(const Map& map, const Chains& chains, std::uint64_t query, ClosureCounts& counts);

  /// Nodes worth matching against, nearest first: at most knearest_neighbors, none within the neighbourhood of another
  /// or of the query. find() sets how uncertain each is.
  std::vector<std::uint64_t> candidates(const Map& map, const Chains& chains, std::uint64_t query) const;

 private:
  std::vector<std::uint64_t> nearest(const std::vector<std::pair<double, std::uint64_t>>& by_distance,
                                     const Chains& chains, std::uint64_t query, int id_threshold) const;
  /// Sets `reason` when there is no closure.
  std::optional<Closure> match(const Map& map, const Chains& chains, std::uint64_t query, std::uint64_t candidate,
                               const SearchWindow& window, std::string& reason);
  SearchWindow window(const Map& map, std::uint64_t query, std::uint64_t candidate) const;
  bool must_be_confirmed(const Map& map, const Closure& closure) const;

  LoopClosureGraphBuilderParameters parameters_;
  LoopMatcher scan_matcher_;
  LoopMatcher way_matcher_;
  RelativeUncertainty uncertainty_;
  std::vector<std::optional<Eigen::Matrix3d>> from_query_;  // covariance of T_query_node by node, along the map's axes
  ClosureConfirmation confirmation_;
};

}  // namespace oort
