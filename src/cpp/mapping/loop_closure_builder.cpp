// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapping/loop_closure_builder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "oort/mapping/frsm_setup.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

// Of submaps in memory at once: enough for the places a robot passes between two visits to one of them.
constexpr std::size_t kSubmapCacheBytes = std::size_t{128} << 20;

// The rough match looks at this many points, evenly chosen; the fine one looks at all of them around the rough
// one's pose.
constexpr std::size_t kRoughPoints = 100;
constexpr double kFineCells = 3.0;
constexpr double kFineThetaSteps = 4.0;

frsm::Points thinned(const frsm::Points& points) {
  if (points.size() <= kRoughPoints) return points;
  frsm::Points some;
  for (std::size_t i = 0; i < kRoughPoints; ++i) some.push_back(points[i * points.size() / kRoughPoints]);
  return some;
}

std::uint64_t id_distance(std::uint64_t a, std::uint64_t b) {
  return a > b ? a - b : b - a;
}

/// Whether two nodes follow so closely on one another that the chain links them better than a closure could. Nodes of
/// other segments never do: nothing tracked the sensor from one to the other.
bool is_recent(const Chains& chains, std::uint64_t node, std::uint64_t query, int id_threshold) {
  return chains.same_segment(node, query) && id_distance(node, query) < static_cast<std::uint64_t>(id_threshold);
}

/// What a closure would move: from where the graph expects node `to` to where the match puts it.
struct Difference {
  double distance;
  double angle;
};

/// The rules of the documented match_filter (REQUIREMENTS O-87, C-17, C-22); the reason of a refusal, or "".
std::string refusal(const MatchFilterParameters& filter, double hits, const Difference& difference, bool is_close,
                    bool is_opposite) {
  if (is_close) {
    if (difference.distance >= filter.close_node_max_dist) return "close_distance";
    if (difference.angle >= filter.match_max_ang_diff) return "angle";
    return hits >= filter.close_node_hitpct_threshold ? "" : "close_hits";
  }
  const double needed = is_opposite ? filter.match_hitpct_threshold_opposite_dir : filter.match_hitpct_threshold;
  const double needed_far =
      is_opposite ? filter.match_hitpct_threshold_high_opposite_dir : filter.match_hitpct_threshold_high;
  if (difference.distance < filter.match_max_dist && hits > needed) return "";
  if (difference.distance < filter.match_max_dist_high && hits > needed_far) return "";
  return difference.distance < filter.match_max_dist_high ? "hits" : "distance";
}

}  // namespace

LoopClosureBuilder::LoopClosureBuilder(const Parameters& parameters)
    : parameters_(parameters.loop_closure_graph_builder),
      table_(table_params(parameters.incremental_graph_builder.frsm_matcher)),
      submaps_(static_cast<std::uint64_t>(parameters_.candidate_search.submap_neighborhood_size), kSubmapCacheBytes,
               table_, frsm::ContourParams::urg()),
      matcher_(matcher_params(parameters.incremental_graph_builder.frsm_matcher)) {}

std::vector<Closure> LoopClosureBuilder::find(const Map& map, const Chains& chains, std::uint64_t query,
                                              ClosureCounts& counts) {
  std::vector<Closure> closures;
  const std::vector<std::uint64_t> found = candidates(map, chains, query);
  if (found.empty()) return closures;
  const frsm::Points points = gather_points(
      map, chains, query,
      chains.neighborhood(query, static_cast<std::uint64_t>(parameters_.frsm_matcher.query_neighborhood_size)));
  for (const std::uint64_t candidate : found) {
    ++counts.tried;
    std::string reason;
    std::optional<Closure> closure = match(map, chains, query, points, candidate, reason);
    if (closure) {
      ++counts.accepted;
      closures.push_back(*closure);
    } else {
      ++counts.refused[reason];
    }
  }
  return closures;
}

std::vector<std::uint64_t> LoopClosureBuilder::candidates(const Map& map, const Chains& chains,
                                                          std::uint64_t query) const {
  const CandidateSearchParameters& search = parameters_.candidate_search;
  const Eigen::Vector2d center = map.graph.nodes[query].pose.translation();
  std::vector<std::pair<double, std::uint64_t>> by_distance;
  for (const Node& node : map.graph.nodes) {
    const bool has_submap =
        (node.id - chains.segment_begin(node.id)) % static_cast<std::uint64_t>(search.candidate_stride) == 0;
    const double distance = (node.pose.translation() - center).norm();
    const bool in_reach = search.max_candidate_distance == 0.0 || distance <= search.max_candidate_distance;
    if (in_reach && has_submap && node.id != query &&
        !is_recent(chains, node.id, query, search.closest_allowed_id_threshold_small)) {
      by_distance.emplace_back(distance, node.id);
    }
  }
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<std::uint64_t> chosen = nearest(by_distance, chains, query, search.closest_allowed_id_threshold_large);
  if (!chosen.empty()) return chosen;
  return nearest(by_distance, chains, query, search.closest_allowed_id_threshold_small);
}

std::vector<std::uint64_t> LoopClosureBuilder::nearest(const std::vector<std::pair<double, std::uint64_t>>& by_distance,
                                                       const Chains& chains, std::uint64_t query,
                                                       int id_threshold) const {
  const CandidateSearchParameters& search = parameters_.candidate_search;
  const auto hops = std::max<std::uint64_t>((static_cast<std::uint64_t>(search.submap_neighborhood_size) + 1) / 2, 1);
  std::vector<std::uint64_t> chosen;
  const auto covered = [&](std::uint64_t node, std::uint64_t by) {
    return chains.same_segment(node, by) && id_distance(node, by) <= hops;
  };
  for (const auto& [distance, node] : by_distance) {
    if (chosen.size() == static_cast<std::size_t>(search.knearest_neighbors)) break;
    if (is_recent(chains, node, query, id_threshold) || covered(node, query)) continue;
    if (std::none_of(chosen.begin(), chosen.end(), [&](std::uint64_t other) { return covered(node, other); })) {
      chosen.push_back(node);
    }
  }
  return chosen;
}

std::optional<Closure> LoopClosureBuilder::match(const Map& map, const Chains& chains, std::uint64_t query,
                                                 const frsm::Points& query_points, std::uint64_t candidate,
                                                 std::string& reason) {
  const FrsmLoopMatcherParameters& p = parameters_.frsm_matcher;
  const auto neighbors =
      chains.neighborhood(candidate, static_cast<std::uint64_t>(parameters_.candidate_search.submap_neighborhood_size));
  if (neighbors.size() <= static_cast<std::size_t>(p.submap_min_neighborhood_size)) {
    reason = "small_submap";
    return std::nullopt;
  }
  const Pose2 T_candidate_query = between(map.graph.nodes[candidate].pose, map.graph.nodes[query].pose);
  const std::shared_ptr<const frsm::Table> submap = submaps_.get(map, chains, candidate);
  const frsm::Prior prior{to_frsm(T_candidate_query), Eigen::Vector3d(p.search_window_xy * p.search_window_xy,
                                                                      p.search_window_xy * p.search_window_xy,
                                                                      p.search_window_theta * p.search_window_theta)
                                                          .asDiagonal()};
  const frsm::Match rough = matcher_.match(*submap, thinned(query_points), prior.mean,
                                           {p.search_window_xy, p.search_window_xy, p.search_window_theta}, &prior);
  if (rough.hits == 0) {
    reason = "no_overlap";
    return std::nullopt;
  }
  if (rough.hit_fraction < p.rough_match_hitpct_threshold) {
    reason = "rough_hits";
    return std::nullopt;
  }
  if (rough.saturated) {
    reason = "window_border";
    return std::nullopt;
  }
  const double fine_xy = kFineCells * table_.cell;
  const frsm::Match fine = matcher_.match(*submap, query_points, rough.pose,
                                          {fine_xy, fine_xy, kFineThetaSteps * matcher_.params().theta_step}, &prior);
  if (fine.hit_fraction < p.fine_match_hitpct_threshold) {
    reason = "fine_hits";
    return std::nullopt;
  }
  const Pose2 T_match = from_frsm(fine.pose);
  const Pose2 moved = between(T_candidate_query, T_match);
  reason = refusal(p.match_filter, fine.hit_fraction, {moved.translation().norm(), std::abs(moved.theta)},
                   is_recent(chains, candidate, query, parameters_.candidate_search.closest_allowed_id_threshold_large),
                   std::abs(T_candidate_query.theta) >= p.match_filter.opposite_dir_threshold);
  if (!reason.empty()) return std::nullopt;
  return Closure{query, candidate, inverse(T_match), inverse_covariance(T_match, fine.covariance), fine.hit_fraction};
}

}  // namespace oort
