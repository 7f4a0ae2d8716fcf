// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "oort/geometry/work_meter.hpp"
#include "oort/graph/relative_uncertainty.hpp"
#include "oort/loop_closure/closure.hpp"
#include "oort/loop_closure/closure_confirmation.hpp"
#include "oort/loop_closure/closure_log.hpp"
#include "oort/loop_closure/loop_matcher.hpp"
#include "oort/loop_closure/statistics.hpp"
#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// How far loops are looked for and what is accepted, by the matcher that loop_closure_graph_builder.scanmatcher names.
struct LoopSearch {
  double window_xy = 0.0;      ///< widest half width [m]
  double window_theta = 0.0;   ///< widest half width [rad]
  double window_sigmas = 0.0;  ///< half width by the graph's uncertainty [standard deviations]; 0: always the widest
  double min_facing_share = 0.0;
  MatchFilterParameters match_filter;

  bool is_adaptive() const { return window_sigmas > 0.0; }
};

/// Looks for places seen before and measures where the newest node stands in their submaps (docs/loops.md).
///
/// How far it looks follows from how well the graph knows where the newest node is, as seen from the candidate. Where
/// that is well, one scan is matched. Where it is not, one scan of a short-range sensor looks like too many places: the
/// last metres are matched together, and what would move the newest node far waits until it is confirmed.
class LoopClosureBuilder {
 public:
  explicit LoopClosureBuilder(const Parameters& parameters);

  const LoopSearch& search() const { return search_; }

  /// Notes what is worth an attempt now that the newest node, `query`, is there.
  void look(const Map& map, const TrajectorySegments& segments, std::uint64_t query, WorkMeter* meter = nullptr) {
    look_before(map, segments, query, map.graph.nodes.size(), meter);
  }

  /// The same of any node, with candidates among the nodes before `end` only.
  void look_before(const Map& map, const TrajectorySegments& segments, std::uint64_t query, std::uint64_t end,
                   WorkMeter* meter = nullptr);

  /// Whether the node is one of those that look for loops in wide windows, too.
  static bool looks_wide(const TrajectorySegments& segments, std::uint64_t query);

  bool has_work() const { return !waiting_.empty(); }

  /// Does the next piece of what was noted: draws some scans of a submap, or makes one attempt. Returns the closures
  /// that are accepted with it.
  std::vector<Closure> work(const Map& map, const TrajectorySegments& segments, ClosureCounts& counts, ClosureLog& log,
                            WorkMeter* meter = nullptr);

  /// Does all of what was noted.
  std::vector<Closure> work_off(const Map& map, const TrajectorySegments& segments, ClosureCounts& counts,
                                ClosureLog& log);

  /// Nodes worth matching against, nearest first: at most knearest_neighbors, none within the neighbourhood of another
  /// or of the query, all before `end`. look() sets how uncertain each is.
  std::vector<std::uint64_t> candidates(const Map& map, const TrajectorySegments& segments, std::uint64_t query,
                                        std::uint64_t end = std::numeric_limits<std::uint64_t>::max()) const;

 private:
  std::vector<std::uint64_t> nearest(const std::vector<std::pair<double, std::uint64_t>>& by_distance,
                                     const TrajectorySegments& segments, std::uint64_t query, int id_threshold) const;
  struct Attempt {
    std::uint64_t query;
    std::uint64_t candidate;
    SearchWindow window;
  };
  LoopMatcher& matcher_for(const Attempt& attempt);
  std::vector<Closure> make(const Attempt& attempt, const Map& map, const TrajectorySegments& segments,
                            ClosureCounts& counts, ClosureLog& log, WorkMeter* meter);
  LoopMatcher::Found match(const Map& map, const TrajectorySegments& segments, const Attempt& attempt,
                           WorkMeter* meter);
  SearchWindow window(const Map& map, std::uint64_t query, std::uint64_t candidate) const;
  bool must_be_confirmed(const Map& map, const Closure& closure) const;

  LoopClosureGraphBuilderParameters parameters_;
  LoopSearch search_;
  std::unique_ptr<LoopMatcher> scan_matcher_;
  std::unique_ptr<LoopMatcher> wide_matcher_;
  RelativeUncertainty uncertainty_;
  std::vector<std::optional<Eigen::Matrix3d>> from_query_;  // covariance of T_query_node by node, along the map's axes
  ClosureConfirmation confirmation_;
  std::deque<Attempt> waiting_;  // oldest first
};

}  // namespace oort
