// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/merging/map_placement.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "oort/grid/voxel_filter.hpp"
#include "oort/localization/relocalizer.hpp"
#include "oort/matching/frsm_adapter.hpp"
#include "oort/matching/frsm_setup.hpp"
#include "oort/merging/internal/map_views.hpp"
#include "oort/merging/tuning.hpp"

namespace oort {
namespace {

/// Where the query map, whose views are looked for, may lie on the target, the other map.
struct Vote {
  std::size_t view;
  Pose2 T_target_query;
};

bool near(const Pose2& a, const Pose2& b) {
  const Pose2 difference = between(a, b);
  return difference.translation().norm() <= MergingTuning::kSamePlacement &&
         std::abs(difference.theta) <= MergingTuning::kSamePlacementAngle;
}

/// One map, its views looked for on another.
class PlacementSearch {
 public:
  PlacementSearch(const Map& target, const Map& query, const Parameters& parameters)
      : target_(target),
        query_(query),
        reference_(std::make_shared<ReferenceMap>(target, parameters)),
        relocalizer_(reference_, parameters),
        matcher_(matcher_params(parameters.incremental_graph_builder.frsm_matcher)),
        views_(spread_views(query, TrajectorySegments::of_map(query), MergingTuning::kMaxViews,
                            MergingTuning::kViewSpacing, MergingTuning::kNodesPerView)) {}

  std::size_t size() const { return views_.size(); }

  /// Placements that views have without a guess, those that most views agree with first, apart from each other.
  std::vector<Pose2> candidates() const {
    const std::vector<Vote> all = votes();
    std::vector<std::pair<int, std::size_t>> ranked;  // how many views agree, less than 0; the vote
    for (std::size_t k = 0; k < all.size(); ++k) ranked.emplace_back(-count_agreeing(all, all[k]), k);
    std::sort(ranked.begin(), ranked.end());
    std::vector<Pose2> chosen;
    for (const auto& [count, k] : ranked) {
      if (chosen.size() == MergingTuning::kMaxPlacements) break;
      const Pose2& pose = all[k].T_target_query;
      if (std::none_of(chosen.begin(), chosen.end(), [&](const Pose2& other) { return same(other, pose); })) {
        chosen.push_back(pose);
      }
    }
    return chosen;
  }

  /// Whether two placements put most views at the same places.
  bool same(const Pose2& a, const Pose2& b) const {
    const auto at_same_place = [&](const MapView& view) { return near(a * view.T_map_sensor, b * view.T_map_sensor); };
    return 2 * std::count_if(views_.begin(), views_.end(), at_same_place) > static_cast<std::ptrdiff_t>(views_.size());
  }

  /// What all views say of a placement. It is moved to where those that fit say.
  MapPlacement weigh(const Pose2& T_target_query) const {
    return summary(opinions(middle(opinions(T_target_query), T_target_query)), T_target_query);
  }

 private:
  /// What a view says of a placement, near to which it was matched.
  struct Opinion {
    std::size_t view;
    Pose2 T_target_query;  ///< as matched
    Support matched;       ///< there
    Support expected;      ///< at the placement itself

    bool fits() const { return matched.value() >= MergingTuning::kFits; }
    bool contradicts() const { return cannot_be(matched) && cannot_be(expected); }

    /// A wall that was seen from its other side only is nothing impossible.
    static bool cannot_be(const Support& support) {
      return support.blocked + support.in_free > MergingTuning::kContradicts * support.points;
    }
  };

  std::vector<Vote> votes() const {
    std::vector<Vote> votes;
    for (std::size_t k = 0; k < views_.size(); ++k) {
      const Relocalization found = relocalizer_.find(views_[k].scans);
      for (const auto& hypothesis : {found.best, found.second}) {
        if (hypothesis) votes.push_back({k, hypothesis->T_map_sensor * inverse(views_[k].T_map_sensor)});
      }
    }
    return votes;
  }

  int count_agreeing(const std::vector<Vote>& votes, const Vote& vote) const {
    std::vector<bool> agrees(views_.size(), false);
    for (const Vote& other : votes) {
      const Pose2& here = views_[vote.view].T_map_sensor;
      const Pose2& there = views_[other.view].T_map_sensor;
      if (near(vote.T_target_query * here, other.T_target_query * here) &&
          near(vote.T_target_query * there, other.T_target_query * there)) {
        agrees[other.view] = true;
      }
    }
    return static_cast<int>(std::count(agrees.begin(), agrees.end(), true));
  }

  std::vector<Opinion> opinions(const Pose2& T_target_query) const {
    std::vector<Opinion> opinions;
    for (std::size_t k = 0; k < views_.size(); ++k) {
      const Pose2 expected = T_target_query * views_[k].T_map_sensor;
      const frsm::Match match = matcher_.match(
          reference_->fine(), points_of(views_[k]), to_frsm(expected),
          {MergingTuning::kMatchReach, MergingTuning::kMatchReach, MergingTuning::kMatchReachAngle}, nullptr);
      const Pose2 matched = from_frsm(match.pose);
      opinions.push_back({k, matched * inverse(views_[k].T_map_sensor), support(k, matched), support(k, expected)});
    }
    return opinions;
  }

  Support support(std::size_t view, const Pose2& T_target_sensor) const {
    Support support;
    const std::vector<PlacedScan>& scans = views_[view].scans;
    for (const PlacedScan& scan : scans) {
      reference_->weigh(scan.cloud, T_target_sensor * between(scans.back().T_odom_sensor, scan.T_odom_sensor), support);
    }
    return support;
  }

  static frsm::Points points_of(const MapView& view) {
    frsm::Points points;
    for (const PlacedScan& scan : view.scans) {
      append_transformed(returns_of(scan.cloud), between(view.scans.back().T_odom_sensor, scan.T_odom_sensor), points);
    }
    frsm::Points thinned;
    for (const Eigen::Vector2d& p : voxel_filter(to_points(frsm::drop_invalid(points)), MergingTuning::kMatchVoxel)) {
      thinned.push_back({p.x(), p.y()});
    }
    return thinned;
  }

  /// Of the views that fit, the placement that most others agree with; `otherwise` if none fits.
  Pose2 middle(const std::vector<Opinion>& opinions, const Pose2& otherwise) const {
    Pose2 best = otherwise;
    double least = -1.0;
    for (const Opinion& one : opinions) {
      if (!one.fits()) continue;
      double apart = 0.0;
      for (const Opinion& other : opinions) {
        if (!other.fits()) continue;
        const Pose2& there = views_[other.view].T_map_sensor;
        apart += (one.T_target_query * there.translation() - other.T_target_query * there.translation()).norm();
      }
      if (least >= 0.0 && apart >= least) continue;
      least = apart;
      best = one.T_target_query;
    }
    return best;
  }

  /// With the target as map a and the query as map b.
  MapPlacement summary(const std::vector<Opinion>& opinions, const Pose2& otherwise) const {
    MapPlacement placement;
    placement.T_a_b = middle(opinions, otherwise);
    const Opinion* best = nullptr;
    for (const Opinion& one : opinions) {
      if (one.fits()) ++placement.fits;
      if (one.contradicts()) ++placement.contradicts;
      if (best == nullptr || one.matched.value() > best->matched.value()) best = &one;
    }
    if (best == nullptr) return placement;
    placement.node_b = views_[best->view].node;
    placement.node_a = nearest(best->T_target_query * query_.graph.nodes[placement.node_b].pose.translation());
    return placement;
  }

  std::uint64_t nearest(const Eigen::Vector2d& p_target) const {
    const auto& nodes = target_.graph.nodes;
    return std::min_element(nodes.begin(), nodes.end(),
                            [&](const Node& a, const Node& b) {
                              return (a.pose.translation() - p_target).squaredNorm() <
                                     (b.pose.translation() - p_target).squaredNorm();
                            })
        ->id;
  }

  const Map& target_;
  const Map& query_;
  std::shared_ptr<const ReferenceMap> reference_;
  Relocalizer relocalizer_;
  frsm::Matcher matcher_;
  std::vector<MapView> views_;
};

/// The same seen from the other map.
MapPlacement swapped(MapPlacement placement) {
  placement.T_a_b = inverse(placement.T_a_b);
  std::swap(placement.node_a, placement.node_b);
  return placement;
}

}  // namespace

MapSearch find_placements(const Map& a, const Map& b, const Parameters& parameters,
                          const std::vector<MapPlacement>& guesses, bool only_guesses) {
  const bool swap = b.graph.nodes.size() > a.graph.nodes.size();
  const PlacementSearch search(swap ? b : a, swap ? a : b, parameters);
  MapSearch result;
  result.views = static_cast<int>(search.size());
  result.needed = only_guesses ? std::min(MergingTuning::kNeededViews, result.views) : MergingTuning::kNeededViews;
  const auto add = [&](const Pose2& T_target_query, const std::string& found_by) {
    MapPlacement placement = search.weigh(T_target_query);
    placement.found_by = found_by;
    const auto is_same = [&](const MapPlacement& other) { return search.same(other.T_a_b, placement.T_a_b); };
    if (std::any_of(result.placements.begin(), result.placements.end(), is_same)) return;
    result.placements.push_back(placement);
  };
  for (const MapPlacement& guess : guesses) add(swap ? inverse(guess.T_a_b) : guess.T_a_b, guess.found_by);
  if (!only_guesses) {
    for (const Pose2& pose : search.candidates()) add(pose, "search");
  }
  std::stable_sort(result.placements.begin(), result.placements.end(),
                   [](const MapPlacement& p, const MapPlacement& q) { return p.score() > q.score(); });
  if (swap) std::transform(result.placements.begin(), result.placements.end(), result.placements.begin(), swapped);
  return result;
}

}  // namespace oort
