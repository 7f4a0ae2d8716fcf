// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/drift_search.hpp"

#include <algorithm>
#include <cmath>

#include "oort/graph/relative_uncertainty.hpp"
#include "oort/localization/place_tuning.hpp"
#include "oort/loop_closure/tuning.hpp"
#include "oort/maintenance/tied_segments.hpp"
#include "oort/map/part_nodes.hpp"
#include "oort/mapper/tuning.hpp"

namespace oort {
namespace {

double apart(const Map& map, std::uint64_t a, std::uint64_t b) {
  return (map.graph.nodes[a].pose.translation() - map.graph.nodes[b].pose.translation()).norm();
}

std::uint64_t travel(const TrajectorySegments& segments) {
  return segments.size() == 0 ? 0 : segments.travel_between(0, segments.size() - 1);
}

/// One past the newest node that so much way [m] lies behind.
std::uint64_t end_of_older(const Map& map, std::uint64_t newest, double way) {
  std::uint64_t node = newest;
  for (; node > 0 && way > 0.0; --node) way -= apart(map, node, node - 1);
  return way > 0.0 ? 0 : node + 1;
}

}  // namespace

bool DriftSearch::is_due(const TrajectorySegments& segments) const {
  return loops_.is_adaptive() && travel(segments) >= std::max<std::uint64_t>(due_, 1);
}

void DriftSearch::schedule(const TrajectorySegments& segments, std::uint64_t spacing) {
  due_ = travel(segments) + spacing;
}

void DriftSearch::refuted(const TrajectorySegments& segments) {
  schedule(segments, MapperTuning::kDriftPause);
}

std::vector<Closure> DriftSearch::look(const Map& map, const TrajectorySegments& segments, WorkMeter* meter) {
  return look_for(map.graph.nodes.size() - 1, map, segments, meter);
}

std::vector<Closure> DriftSearch::look_at_end(const Map& map, const TrajectorySegments& segments, std::uint64_t begin) {
  if (!loops_.is_adaptive()) return {};
  const std::uint64_t count = map.graph.nodes.size();
  answers_.clear();
  std::vector<Closure> closures;
  for (std::uint64_t back = MapperTuning::kDriftAtEnd; back > 0 && closures.empty(); --back) {
    const std::uint64_t before = (back - 1) * MapperTuning::kDriftSpacingSoon;
    if (begin + before < count) closures = look_for(count - 1 - before, map, segments, nullptr);
  }
  return closures;
}

std::vector<Closure> DriftSearch::look_for(std::uint64_t node, const Map& map, const TrajectorySegments& segments,
                                           WorkMeter* meter) {
  schedule(segments, MapperTuning::kDriftSpacing);
  const std::uint64_t end = end_of_older(map, node, MapperTuning::kDriftWay);
  const std::vector<std::uint64_t> parts = tied_parts(map.graph, segments);
  const std::uint64_t main = largest_part(parts, end);
  // What nothing ties to it is looked for everywhere, by more (SegmentSearch).
  if (end == 0 || parts[node] != main) return {};
  charge(meter, LoopClosureTuning::kWorkPerNode * static_cast<double>(map.graph.nodes.size()) +
                    LoopClosureTuning::kWorkPerEdge *
                        static_cast<double>(map.graph.edges.size() + map.graph.switchable_edges.size()));
  RelativeUncertainty uncertainty;
  uncertainty.update(map.graph);
  const Known known = uncertainty.from(map.graph, node);
  const std::vector<std::uint64_t> older = nodes_of(parts, main, end);
  Doubt doubt = widest(map, node);
  if (!narrow(doubt, map, older, known)) {
    answers_.clear();
    return {};
  }
  if (!finder_.use(map, older, false, meter, MapperTuning::kDriftViewSpacing)) {
    refuted(segments);
    return {};
  }
  const PlaceSearch search{MapperTuning::kDriftViewSpacing, doubt.area, doubt.max_expansions,
                           MapperTuning::kDriftSupport, false};
  const Look look = finder_.find(map, segments, end, node, meter, search);
  const bool is_news = look.answer && says_more(*look.answer, map, known);
  if (is_news) answers_.add(*look.answer, map);
  misses_ = is_news ? 0 : misses_ + 1;
  if (misses_ >= MapperTuning::kDriftMisses) answers_.clear();
  if (answers_.empty()) return {};
  schedule(segments, MapperTuning::kDriftSpacingSoon);
  if (!answers_.are_enough(map, MapperTuning::kAgreeingAnswers, MapperTuning::kDriftAnswersApart)) return {};
  std::vector<Closure> closures;
  for (const FoundPlace& answer : answers_.all()) closures.push_back(finder_.closure(answer, map));
  answers_.clear();
  return closures;
}

/// Near where the map has the node mostly; where the last answer leads if there is one.
DriftSearch::Doubt DriftSearch::widest(const Map& map, std::uint64_t node) {
  const Pose2& T_map_node = map.graph.nodes[node].pose;
  const bool is_far = ++looks_ % MapperTuning::kDriftFarEvery == 0;
  if (answers_.empty() && is_far) {
    return {{T_map_node, MapperTuning::kDriftFar, MapperTuning::kDriftFarTheta}, MapperTuning::kDriftFarExpansions};
  }
  Pose2 middle = T_map_node;
  if (!answers_.empty()) {
    const FoundPlace& answer = answers_.newest();
    middle = answer.T_map_node * between(map.graph.nodes[answer.node].pose, T_map_node);
  }
  return {{middle, MapperTuning::kDriftNear, MapperTuning::kDriftNearTheta}, PlaceTuning::kSearchExpansions};
}

/// Whether loops with the node are searched for as far as they may be open.
bool DriftSearch::is_known(std::uint64_t node, const Known& known) const {
  return !known[node] ||
         loops_.window_sigmas * std::sqrt(known[node]->topLeftCorner<2, 2>().trace()) <= loops_.window_xy;
}

/// Whether an answer leads where the graph may have the node without knowing it.
bool DriftSearch::says_more(const FoundPlace& answer, const Map& map, const Known& known) const {
  const std::uint64_t nearest = finder_.nearest(answer, map);
  return !is_known(nearest, known) && finder_.may_have_drifted(answer, map, known[nearest]);
}

/// To where the graph leaves open where the newest node is on what was mapped long before. False if that is nowhere, or
/// no farther than loops are searched for.
bool DriftSearch::narrow(Doubt& doubt, const Map& map, const std::vector<std::uint64_t>& older,
                         const Known& known) const {
  double xy = 0.0, theta = 0.0;
  for (const std::uint64_t node : older) {
    if (is_known(node, known)) continue;
    const double wanted = loops_.window_sigmas * std::sqrt(known[node]->topLeftCorner<2, 2>().trace());
    const double distance = between(doubt.area.T_map_sensor, map.graph.nodes[node].pose).translation().norm();
    if (distance > std::min(wanted, doubt.area.xy)) continue;
    xy = std::max(xy, wanted);
    theta = std::max(theta, loops_.window_sigmas * std::sqrt((*known[node])(2, 2)));
  }
  doubt.area.xy = std::min(doubt.area.xy, xy);
  doubt.area.theta = std::min(doubt.area.theta, theta);
  return xy > 0.0;
}

std::vector<std::uint64_t> nodes_to_look_again(const Map& map, const TrajectorySegments& segments,
                                               const std::vector<Pose2>& poses_before) {
  std::vector<bool> is_tied(map.graph.nodes.size(), false);
  for (const SwitchableEdge& edge : map.graph.switchable_edges) {
    const bool is_long = segments.travel_between(edge.i, edge.j) > MapperTuning::kDriftPause;
    if (edge.is_on() && is_long) is_tied[edge.i] = is_tied[edge.j] = true;
  }
  std::vector<std::uint64_t> nodes;
  for (const Node& node : map.graph.nodes) {
    const double moved = (node.pose.translation() - poses_before[node.id].translation()).norm();
    if (moved > MapperTuning::kLookAgain && !is_tied[node.id] && LoopClosureBuilder::looks_wide(segments, node.id)) {
      nodes.push_back(node.id);
    }
  }
  return nodes;
}

}  // namespace oort
