// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/frsm_loop_matcher.hpp"

#include <algorithm>
#include <memory>

#include "oort/loop_closure/tuning.hpp"
#include "oort/matching/frsm_adapter.hpp"
#include "oort/matching/frsm_setup.hpp"

namespace oort {
namespace {

frsm::Points thinned(const frsm::Points& points, std::size_t count) {
  if (count == 0 || points.size() <= count) return points;
  frsm::Points some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(points[i * points.size() / count]);
  return some;
}

frsm::MatcherParams loop_matcher_params(const FrsmMatcherParameters& p, const LoopScale& scale,
                                        double min_inlier_ratio) {
  frsm::MatcherParams params = matcher_params(p);
  params.ambiguity_floor = scale.max_ambiguity;
  params.min_score = LoopClosureTuning::kScorePerInlier * min_inlier_ratio;
  return params;
}

frsm::TableParams loop_table_params(const FrsmMatcherParameters& p, const LoopScale& scale) {
  frsm::TableParams params = table_params(p);
  params.radius = std::min(params.radius, scale.reach);
  return params;
}

}  // namespace

FrsmLoopMatcher::FrsmLoopMatcher(const Parameters& parameters, const LoopScale& scale)
    : parameters_(parameters.loop_closure_graph_builder.frsm_matcher),
      scale_(scale),
      table_(loop_table_params(parameters.incremental_graph_builder.frsm_matcher, scale)),
      submaps_(
          table_cache(scale.submap_nodes, LoopClosureTuning::kSubmapCacheBytes, table_, frsm::ContourParams::urg())),
      matcher_(loop_matcher_params(parameters.incremental_graph_builder.frsm_matcher, scale,
                                   parameters_.fine_match_hitpct_threshold)),
      error_(scale.bend() + match_error(parameters.incremental_graph_builder.frsm_matcher)) {}

bool FrsmLoopMatcher::is_small(const TrajectorySegments& segments, std::uint64_t candidate) const {
  return segments.neighborhood(candidate, scale_.submap_nodes).size() <=
         static_cast<std::size_t>(parameters_.submap_min_neighborhood_size);
}

bool FrsmLoopMatcher::draw(const Map& map, const TrajectorySegments& segments, std::uint64_t candidate,
                           WorkMeter* meter) {
  if (is_small(segments, candidate)) return false;
  const std::size_t scans = std::min(submaps_.undrawn(segments, candidate), LoopClosureTuning::kScansPerPiece);
  if (scans == 0) return false;
  charge(meter, static_cast<double>(scans) * work_of_drawing(map.clouds[candidate], table_.radius));
  return submaps_.draw(map, segments, candidate, scans);
}

LoopMatcher::Found FrsmLoopMatcher::find(const Map& map, const TrajectorySegments& segments, std::uint64_t query,
                                         std::uint64_t candidate, const SearchWindow& window, WorkMeter* meter) {
  const Pose2 expected = between(map.graph.nodes[candidate].pose, map.graph.nodes[query].pose);
  const auto rejected = [](Rejection rejection, const Pose2& pose, double inlier_ratio) {
    return Found{pose, Eigen::Matrix3d::Zero(), inlier_ratio, rejection};
  };
  if (is_small(segments, candidate)) return rejected(Rejection::kSmallSubmap, expected, 0.0);
  const frsm::Points points =
      thinned(gather_points(map, segments, query, segments.neighborhood(query, scale_.query_nodes), scale_.reach),
              scale_.fine_points);
  const std::shared_ptr<const frsm::Table> submap = submaps_.get(map, segments, candidate);
  frsm::OnLookups on_lookups;
  if (meter != nullptr) {
    charge(meter, LoopClosureTuning::kFrsmWorkPerPoint * static_cast<double>(points.size()));
    on_lookups = [meter](std::uint64_t lookups) {
      charge(meter, LoopClosureTuning::kFrsmWorkPerLookup * static_cast<double>(lookups));
    };
  }
  const frsm::Prior prior{to_frsm(expected), window.covariance};
  const frsm::Match rough = matcher_.match(*submap, thinned(points, scale_.rough_points), prior.mean,
                                           {window.xy, window.xy, window.theta}, &prior, on_lookups);
  if (rough.status == frsm::Status::kNoOverlap) return rejected(Rejection::kNoHits, expected, 0.0);
  const Pose2 roughly = from_frsm(rough.pose);
  if (rough.inlier_ratio < parameters_.rough_match_hitpct_threshold) {
    return rejected(Rejection::kRoughHits, roughly, rough.inlier_ratio);
  }
  if (rough.saturated) return rejected(Rejection::kWindowBorder, roughly, rough.inlier_ratio);
  if (rough.ambiguity > scale_.max_ambiguity) return rejected(Rejection::kAmbiguous, roughly, rough.inlier_ratio);
  const double fine_xy = LoopClosureTuning::kFineCells * table_.cell;
  const frsm::Match fine = matcher_.match(
      *submap, points, rough.pose,
      {fine_xy, fine_xy, LoopClosureTuning::kFineThetaSteps * matcher_.params().theta_step}, &prior, on_lookups);
  return {from_frsm(fine.pose), fine.covariance + error_, fine.inlier_ratio,
          fine.inlier_ratio < parameters_.fine_match_hitpct_threshold ? Rejection::kFineHits : Rejection::kNone};
}

}  // namespace oort
