// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/loop_closure_builder.hpp"

#include <algorithm>
#include <cmath>

#include "oort/loop_closure/normal_consistency.hpp"
#include "oort/loop_closure/tuning.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

/// Of the scans of the last metres, matched together.
constexpr LoopScale kWideScale{LoopClosureTuning::kWideQueryNodes,   LoopClosureTuning::kWideSubmapNodes,
                               LoopClosureTuning::kWideCoarsePoints, LoopClosureTuning::kWideFinePoints,
                               LoopClosureTuning::kWideMaxAmbiguity, LoopClosureTuning::kWideSigma,
                               LoopClosureTuning::kWideSigmaTheta,   LoopClosureTuning::kWideReach};

LoopSearch loop_search(const LoopClosureGraphBuilderParameters& parameters) {
  if (parameters.scanmatcher == "branch_and_bound_matcher") {
    const BranchAndBoundMatcherParameters& p = parameters.branch_and_bound_matcher;
    const FastCorrelativeScanMatcherParameters& window = p.fast_correlative_scan_matcher;
    return {window.linear_search_window, window.angular_search_window, p.search_window_sigmas, p.min_facing_share,
            p.match_filter};
  }
  const FrsmLoopMatcherParameters& p = parameters.frsm_matcher;
  return {p.search_window_xy, p.search_window_theta, p.search_window_sigmas, p.min_facing_share, p.match_filter};
}

LoopScale scan_scale(const LoopClosureGraphBuilderParameters& p, const LoopSearch& search) {
  LoopScale scale;
  if (p.scanmatcher == "frsm_matcher") {
    scale.query_nodes = static_cast<std::uint64_t>(p.frsm_matcher.query_neighborhood_size);
  }
  scale.submap_nodes = static_cast<std::uint64_t>(p.candidate_search.submap_neighborhood_size);
  if (search.is_adaptive()) {
    scale.sigma_xy = LoopClosureTuning::kScanSigma;
    scale.sigma_theta = LoopClosureTuning::kScanSigmaTheta;
  }
  return scale;
}

bool is_wide(const SearchWindow& window) {
  return window.xy > LoopClosureTuning::kWideWindow;
}

/// Whether the node is among the first of a segment that has others before it: where the segment belongs is not known
/// yet.
bool is_seeking(const TrajectorySegments& segments, std::uint64_t query) {
  const std::uint64_t begin = segments.segment_begin(query);
  return begin > 0 && segments.travel_between(begin, query) < kWideScale.query_nodes;
}

/// The window around the expected pose that one scan is enough for.
SearchWindow narrowed(SearchWindow window) {
  window.xy = std::min(window.xy, LoopClosureTuning::kWideWindow);
  return window;
}

/// Whether two nodes follow so closely on one another that the trajectory links them better than a closure could. Nodes
/// of other segments never do: nothing tracked the sensor from one to the other.
bool is_recent(const TrajectorySegments& segments, std::uint64_t node, std::uint64_t query, int id_threshold) {
  return segments.same_segment(node, query) &&
         segments.travel_between(node, query) < static_cast<std::uint64_t>(id_threshold);
}

/// What a closure would move: from where the graph expects node `to` to where the match puts it.
struct Difference {
  double distance;
  double angle;
};

/// The rules of the match_filter (docs/parameters.md tells each threshold).
Rejection gate(const MatchFilterParameters& filter, double inlier_ratio, const Difference& difference, bool is_close,
               bool is_opposite) {
  if (is_close) {
    if (difference.distance >= filter.close_node_max_dist) return Rejection::kCloseDistance;
    if (difference.angle >= filter.match_max_ang_diff) return Rejection::kAngle;
    return inlier_ratio >= filter.close_node_hitpct_threshold ? Rejection::kNone : Rejection::kCloseHits;
  }
  const double needed = is_opposite ? filter.match_hitpct_threshold_opposite_dir : filter.match_hitpct_threshold;
  const double needed_far =
      is_opposite ? filter.match_hitpct_threshold_high_opposite_dir : filter.match_hitpct_threshold_high;
  if (difference.distance < filter.match_max_dist && inlier_ratio > needed) return Rejection::kNone;
  if (difference.distance < filter.match_max_dist_high && inlier_ratio > needed_far) return Rejection::kNone;
  return difference.distance < filter.match_max_dist_high ? Rejection::kHits : Rejection::kDistance;
}

}  // namespace

LoopClosureBuilder::LoopClosureBuilder(const Parameters& parameters)
    : parameters_(parameters.loop_closure_graph_builder),
      search_(loop_search(parameters_)),
      scan_matcher_(make_loop_matcher(parameters, scan_scale(parameters_, search_))),
      wide_matcher_(make_loop_matcher(parameters, kWideScale)) {}

void LoopClosureBuilder::look_before(const Map& map, const TrajectorySegments& segments, std::uint64_t query,
                                     std::uint64_t end, WorkMeter* meter) {
  charge(meter, LoopClosureTuning::kWorkPerNode * static_cast<double>(map.graph.nodes.size()) +
                    LoopClosureTuning::kWorkPerEdge *
                        static_cast<double>(map.graph.edges.size() + map.graph.switchable_edges.size()));
  if (search_.is_adaptive()) {
    uncertainty_.update(map.graph);
    from_query_ = uncertainty_.from(map.graph, query);
  }
  const bool looks_wide = this->looks_wide(segments, query);
  for (const std::uint64_t candidate : candidates(map, segments, query, end)) {
    const SearchWindow window = this->window(map, query, candidate);
    const bool wide = search_.is_adaptive() && is_wide(window);
    if (wide && is_seeking(segments, query)) waiting_.push_back({query, candidate, narrowed(window)});
    if (wide && !looks_wide) continue;
    waiting_.push_back({query, candidate, window});
  }
}

bool LoopClosureBuilder::looks_wide(const TrajectorySegments& segments, std::uint64_t query) {
  const auto strides = [&](std::uint64_t node) {
    return segments.travel_between(0, node) / LoopClosureTuning::kWideStride;
  };
  return query == 0 || strides(query) != strides(query - 1);
}

std::vector<Closure> LoopClosureBuilder::work(const Map& map, const TrajectorySegments& segments, ClosureCounts& counts,
                                              ClosureLog& log, WorkMeter* meter) {
  if (waiting_.empty()) return {};
  const Attempt attempt = waiting_.front();
  if (matcher_for(attempt).draw(map, segments, attempt.candidate, meter)) return {};
  waiting_.pop_front();
  return make(attempt, map, segments, counts, log, meter);
}

std::vector<Closure> LoopClosureBuilder::work_off(const Map& map, const TrajectorySegments& segments,
                                                  ClosureCounts& counts, ClosureLog& log) {
  std::vector<Closure> closures;
  while (!waiting_.empty()) {
    for (const Closure& closure : work(map, segments, counts, log)) closures.push_back(closure);
  }
  return closures;
}

std::vector<Closure> LoopClosureBuilder::make(const Attempt& attempt, const Map& map,
                                              const TrajectorySegments& segments, ClosureCounts& counts,
                                              ClosureLog& log, WorkMeter* meter) {
  LoopMatcher::Found found = match(map, segments, attempt, meter);
  const Closure closure{attempt.query, attempt.candidate, inverse(found.T_candidate_query),
                        inverse_covariance(found.T_candidate_query, found.covariance), found.inlier_ratio};
  std::vector<Closure> believed;
  if (found.rejection == Rejection::kNone) {
    if (must_be_confirmed(map, closure)) {
      believed = confirmation_.add(map, closure);
      if (believed.empty()) found.rejection = Rejection::kUnconfirmed;  // until it is
    } else {
      believed = {closure};
    }
  }
  ++counts.tried;
  if (found.rejection != Rejection::kNone) ++counts.rejected[found.rejection];
  log.add({attempt.query, attempt.candidate, found.rejection, found.T_candidate_query, found.inlier_ratio});
  // Found where it was expected: no need to look farther off.
  const auto is_same = [&](const Attempt& other) {
    return other.query == attempt.query && other.candidate == attempt.candidate;
  };
  if (!believed.empty()) waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), is_same), waiting_.end());
  for (const Closure& accepted : believed) {
    ++counts.accepted;
    if (accepted.from == attempt.query && accepted.to == attempt.candidate) continue;
    --counts.rejected[Rejection::kUnconfirmed];
    log.accept(accepted.from, accepted.to);
  }
  return believed;
}

std::vector<std::uint64_t> LoopClosureBuilder::candidates(const Map& map, const TrajectorySegments& segments,
                                                          std::uint64_t query, std::uint64_t end) const {
  const CandidateSearchParameters& search = parameters_.candidate_search;
  const Eigen::Vector2d center = map.graph.nodes[query].pose.translation();
  std::vector<std::pair<double, std::uint64_t>> by_distance;
  for (const Node& node : map.graph.nodes) {
    if (node.id >= end) break;
    const bool has_submap = segments.begins_stride(node.id, static_cast<std::uint64_t>(search.candidate_stride));
    const double distance = (node.pose.translation() - center).norm();
    double reach = search.max_candidate_distance;
    if (node.id < from_query_.size() && from_query_[node.id]) {
      reach += LoopClosureTuning::kReachSigmas * std::sqrt(from_query_[node.id]->topLeftCorner<2, 2>().trace());
    }
    const bool in_reach = search.max_candidate_distance == 0.0 || distance <= reach;
    if (in_reach && has_submap && node.id != query &&
        !is_recent(segments, node.id, query, search.closest_allowed_id_threshold_small)) {
      by_distance.emplace_back(distance, node.id);
    }
  }
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<std::uint64_t> chosen = nearest(by_distance, segments, query, search.closest_allowed_id_threshold_large);
  if (!chosen.empty()) return chosen;
  return nearest(by_distance, segments, query, search.closest_allowed_id_threshold_small);
}

std::vector<std::uint64_t> LoopClosureBuilder::nearest(const std::vector<std::pair<double, std::uint64_t>>& by_distance,
                                                       const TrajectorySegments& segments, std::uint64_t query,
                                                       int id_threshold) const {
  const CandidateSearchParameters& search = parameters_.candidate_search;
  const auto hops = std::max<std::uint64_t>((static_cast<std::uint64_t>(search.submap_neighborhood_size) + 1) / 2, 1);
  std::vector<std::uint64_t> chosen;
  const auto covered = [&](std::uint64_t node, std::uint64_t by) {
    return segments.same_segment(node, by) && segments.travel_between(node, by) <= hops;
  };
  for (const auto& entry : by_distance) {
    const std::uint64_t node = entry.second;
    if (chosen.size() == static_cast<std::size_t>(search.knearest_neighbors)) break;
    if (is_recent(segments, node, query, id_threshold) || covered(node, query)) continue;
    if (std::none_of(chosen.begin(), chosen.end(), [&](std::uint64_t other) { return covered(node, other); })) {
      chosen.push_back(node);
    }
  }
  return chosen;
}

SearchWindow LoopClosureBuilder::window(const Map& map, std::uint64_t query, std::uint64_t candidate) const {
  const double sigmas = search_.window_sigmas;
  const auto variances = [](double xy, double theta) {
    return Eigen::Matrix3d(Eigen::Vector3d(xy * xy, xy * xy, theta * theta).asDiagonal());
  };
  if (sigmas == 0.0 || !from_query_[candidate]) {
    return {search_.window_xy, search_.window_theta, variances(search_.window_xy, search_.window_theta)};
  }
  const Pose2& T_map_query = map.graph.nodes[query].pose;
  const Eigen::Matrix3d covariance = inverse_covariance(between(T_map_query, map.graph.nodes[candidate].pose),
                                                        rotate_covariance(*from_query_[candidate], -T_map_query.theta));
  SearchWindow window;
  const double wanted_xy = sigmas * std::sqrt(covariance.topLeftCorner<2, 2>().trace());
  window.xy = std::min(std::max(wanted_xy, LoopClosureTuning::kMinWindow), search_.window_xy);
  window.theta = std::min(std::max(sigmas * std::sqrt(covariance(2, 2)), LoopClosureTuning::kMinWindowTheta),
                          search_.window_theta);
  // As a prior it is taken for twice as uncertain: what lies near the border is unlikely, not impossible.
  window.covariance = 0.25 * (sigmas * sigmas * covariance +
                              variances(LoopClosureTuning::kMinWindow, LoopClosureTuning::kMinWindowTheta));
  return window;
}

LoopMatcher& LoopClosureBuilder::matcher_for(const Attempt& attempt) {
  return *(is_wide(attempt.window) && search_.is_adaptive() ? wide_matcher_ : scan_matcher_);
}

LoopMatcher::Found LoopClosureBuilder::match(const Map& map, const TrajectorySegments& segments, const Attempt& attempt,
                                             WorkMeter* meter) {
  const auto [query, candidate, window] = attempt;
  LoopMatcher::Found found = matcher_for(attempt).find(map, segments, query, candidate, window, meter);
  if (found.rejection != Rejection::kNone) return found;
  const Pose2 expected = between(map.graph.nodes[candidate].pose, map.graph.nodes[query].pose);
  const Pose2 moved = between(expected, found.T_candidate_query);
  found.rejection =
      gate(search_.match_filter, found.inlier_ratio, {moved.translation().norm(), std::abs(moved.theta)},
           is_recent(segments, candidate, query, parameters_.candidate_search.closest_allowed_id_threshold_large),
           std::abs(expected.theta) >= search_.match_filter.opposite_dir_threshold);
  if (found.rejection != Rejection::kNone) return found;
  charge(meter, LoopClosureTuning::kWorkPerNormal * static_cast<double>(map.clouds[query].points.size()) *
                    (parameters_.candidate_search.submap_neighborhood_size + 1));
  const NormalMap facing(map, segments, candidate,
                         segments.neighborhood(candidate, static_cast<std::uint64_t>(
                                                              parameters_.candidate_search.submap_neighborhood_size)));
  if (facing.agreement(surface_points(returns_of(map.clouds[query])), found.T_candidate_query) <
      search_.min_facing_share) {
    found.rejection = Rejection::kOtherSide;
  }
  return found;
}

bool LoopClosureBuilder::must_be_confirmed(const Map& map, const Closure& closure) const {
  if (!search_.is_adaptive()) return false;
  const Pose2 expected = between(map.graph.nodes[closure.from].pose, map.graph.nodes[closure.to].pose);
  const Pose2 moved = between(expected, closure.T_from_to);
  return moved.translation().norm() >= LoopClosureTuning::kUnconfirmedDistance ||
         std::abs(moved.theta) >= LoopClosureTuning::kUnconfirmedAngle;
}

}  // namespace oort
