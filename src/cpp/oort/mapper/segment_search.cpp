// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/segment_search.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "oort/maintenance/tied_segments.hpp"
#include "oort/map/part_nodes.hpp"
#include "oort/map/parts.hpp"
#include "oort/map/tuning.hpp"
#include "oort/mapper/tuning.hpp"

namespace oort {
namespace {

bool ties(const SwitchableEdge& edge, std::uint64_t first) {
  return edge.is_on() && std::max(edge.i, edge.j) >= first && std::min(edge.i, edge.j) < first;
}

bool is_tied(const Graph& graph, std::uint64_t first) {
  return std::any_of(graph.switchable_edges.begin(), graph.switchable_edges.end(),
                     [first](const SwitchableEdge& edge) { return ties(edge, first); });
}

/// By a closure that is firm: a robot on its dock is where it says.
bool is_docked(const Graph& graph, std::uint64_t first) {
  return std::any_of(graph.switchable_edges.begin(), graph.switchable_edges.end(),
                     [first](const SwitchableEdge& edge) { return edge.firmness > 1.0 && ties(edge, first); });
}

/// The first of the nodes up to a segment's first one that nothing but odometry placed: what they saw fitted nowhere,
/// as the robot was no longer where odometry had it.
std::uint64_t first_doubtful(const TrajectorySegments& segments, std::uint64_t first) {
  while (first > 0 && !segments.is_matched(first - 1)) --first;
  return first;
}

std::vector<NodeRange> ranges_of(const std::vector<std::uint64_t>& parts, std::uint64_t part) {
  std::vector<NodeRange> ranges;
  for (std::uint64_t node = 0; node < parts.size(); ++node) {
    if (parts[node] != part) continue;
    if (ranges.empty() || ranges.back().end != node) ranges.push_back({node, node});
    ++ranges.back().end;
  }
  return ranges;
}

/// Whether somebody may have carried the robot from the node before `first` to the place.
bool may_be_carried(std::uint64_t first, const FoundPlace& place, const Map& map) {
  const double moved = (place.T_map_node.translation() - map.graph.nodes[place.node].pose.translation()).norm();
  const double elapsed = map.clouds[first].time - map.clouds[first - 1].time;
  return moved <= MapperTuning::kCarriedFar + MapperTuning::kCarriedSpeed * std::max(elapsed, 0.0);
}

bool are_enough(const PlaceAnswers& answers, const Map& map) {
  return answers.are_enough(map, MapperTuning::kAgreeingAnswers, MapperTuning::kAnswersApart);
}

/// At the end, up to so many nodes of a segment.
std::vector<std::uint64_t> nodes_to_look_for(const NodeRange& segment) {
  const std::uint64_t step =
      std::max((segment.end - segment.begin) / MapperTuning::kMaxLooks, MapperTuning::kLeastSearchSpacing);
  std::vector<std::uint64_t> nodes;
  for (std::uint64_t node = segment.begin + MapperTuning::kFirstSearch - 1; node < segment.end; node += step) {
    nodes.push_back(node);
  }
  return nodes;
}

}  // namespace

void SegmentSearch::begin(std::uint64_t first_node, Doubt doubt) {
  first_ = first_node;
  due_ = first_node + (doubt == Doubt::kAll ? MapperTuning::kFirstSearch : MapperTuning::kFirstSearchNearby);
  was_found_ = false;
  doubt_ = doubt;
  is_distrusted_ = false;
  looks_tied_ = contradictions_ = quiet_looks_ = 0;
  answers_.clear();
}

/// Where a new local map was begun not long before, the doubt of then was right: a false closure has ended it.
void SegmentSearch::suspect(std::uint64_t first_node, const TrajectorySegments& segments) {
  if (first_ || first_node < suspect_from_) return;
  const std::uint64_t begin_of_segment = segments.segment_begin(first_node);
  const bool was_doubted = begin_of_segment > 0 && first_node - begin_of_segment < MapperTuning::kSuspectReach;
  begin(was_doubted ? begin_of_segment : first_node, Doubt::kMap);
}

/// When to look next: soon after an answer, which others may confirm, else ever more rarely.
void SegmentSearch::schedule(std::uint64_t count, bool contradicts) {
  const std::uint64_t grown = count - *first_;
  const bool is_likely_elsewhere = doubt_ == Doubt::kAll || contradicts;
  const bool is_soon = is_likely_elsewhere && grown < MapperTuning::kSearchSoon;
  const std::uint64_t parts = is_soon ? MapperTuning::kSearchGrowthParts : MapperTuning::kDoubtGrowthParts;
  const std::uint64_t growth = answers_.empty() ? grown / parts : 0;
  due_ = count + std::max(MapperTuning::kLeastSearchSpacing, growth);
}

SegmentFinding SegmentSearch::look(const Map& map, const TrajectorySegments& segments, WorkMeter* meter) {
  const std::uint64_t count = map.graph.nodes.size(), newest = count - 1;
  if (doubt_ == Doubt::kOdometry) first_ = first_doubtful(segments, *first_);
  const std::uint64_t first = *first_;
  const bool is_tied = oort::is_tied(map.graph, first) || doubt_ == Doubt::kMap;
  if (is_over(map, is_tied)) return ended();
  const std::vector<std::uint64_t> parts = tied_parts(map.graph, segments);
  const std::uint64_t main = largest_part(parts, first);
  if (!finder_.use(map, nodes_of(parts, main, first), doubt_ == Doubt::kAll, meter)) return ended();
  const PlaceFinder::Fit fit = finder_.fit(map, segments, first, newest, meter);
  weigh_tie(is_tied, fit.contradicts);
  if (is_tied && contradicts_mostly() && doubt_ != Doubt::kMap) {
    begin(first, Doubt::kAll);
    is_distrusted_ = true;
    due_ = count + MapperTuning::kLeastSearchSpacing;
    return {{{first}}, true, false, true, {}, {}, std::nullopt};
  }
  Look look;
  const bool is_confirmed = doubt_ == Doubt::kOdometry && !was_found_ && fit.confirms;
  if (!is_confirmed) look = finder_.find(map, segments, first, newest, meter);
  SegmentFinding finding;
  if (look.answer) {
    finding = doubt_ == Doubt::kMap ? take_suspect(*look.answer, first, map) : take(*look.answer, first, map);
  }
  if (!first_) return finding;
  schedule(count, fit.contradicts);
  if (finding.is_nothing()) finding.trusted = trust(look, fit);
  return finding;
}

/// Nothing more is looked for.
SegmentFinding SegmentSearch::ended() {
  forget();
  SegmentFinding finding;
  if (doubt_ == Doubt::kMap) finding.trusted = true;
  return finding;
}

/// Where odometry is merely doubted, closures near by may be believed: they were looked for where it says.
bool SegmentSearch::is_over(const Map& map, bool is_tied) const {
  return *first_ == 0 || is_docked(map.graph, *first_) || (is_tied && doubt_ == Doubt::kOdometry && !was_found_);
}

bool SegmentSearch::contradicts_mostly() const {
  return contradictions_ >= MapperTuning::kContradictions && 2 * contradictions_ >= looks_tied_;
}

/// Whether the place is to be trusted, if that changes. Odometry that was merely doubted is once nothing speaks against
/// it; the search goes on. The map is not while most looks contradict it, and is again once they confirm it.
std::optional<bool> SegmentSearch::trust(const Look& look, const PlaceFinder::Fit& fit) {
  const bool is_of_map = doubt_ == Doubt::kMap;
  const bool is_quiet = fit.confirms || (!is_of_map && !fit.contradicts && look.fits_nowhere);
  quiet_looks_ = is_quiet && answers_.empty() ? quiet_looks_ + 1 : 0;
  if (is_of_map && fit.contradicts && contradicts_mostly()) return false;
  if (doubt_ == Doubt::kAll || quiet_looks_ != MapperTuning::kQuietLooks) return std::nullopt;
  if (is_of_map) {
    forget();
    suspect_from_ = due_ + MapperTuning::kSuspectReach;
  }
  return true;
}

/// Counts the looks at a segment that is tied, and those of them that contradict where it is.
void SegmentSearch::weigh_tie(bool is_tied, bool contradicts) {
  if (!is_tied) looks_tied_ = contradictions_ = 0;
  if (!is_tied) return;
  ++looks_tied_;
  if (contradicts) ++contradictions_;
}

bool SegmentSearch::refuses(const Closure& closure) const {
  return first_ && is_distrusted_ && closure.firmness <= 1.0 && (closure.from < *first_) != (closure.to < *first_);
}

SegmentFinding SegmentSearch::take(const FoundPlace& answer, std::uint64_t first, const Map& map) {
  answers_.add(answer, map);
  if (!are_enough(answers_, map)) return {};
  SegmentFinding finding = placed(answers_, map);
  const bool is_in_reach = doubt_ != Doubt::kOdometry || may_be_carried(first, answers_.newest(), map);
  answers_.clear();
  if (!is_in_reach) return {};
  if (!finding.disproved && is_tied(map.graph, first)) {
    forget();
    return {};
  }
  finding.nodes = {{first}};
  finding.withdrawn = finding.disproved && is_tied(map.graph, first);
  was_found_ = true;
  is_distrusted_ = false;
  looks_tied_ = contradictions_ = 0;
  return finding;
}

/// Of nodes that hang on the map by scans that fitted each other: what answers say is drift if odometry and scans may
/// have drifted so far, and closures mend it. If not, the robot was carried.
SegmentFinding SegmentSearch::take_suspect(const FoundPlace& answer, std::uint64_t first, const Map& map) {
  answers_.add(answer, map);
  if (!are_enough(answers_, map)) return {};
  SegmentFinding finding = placed(answers_, map);
  const bool is_elsewhere = finding.disproved && !finder_.may_have_drifted(answers_.newest(), map);
  const bool is_proved = contradicts_mostly() || answers_.weight() >= MapperTuning::kAnswersAgainstMap;
  if (is_elsewhere && !is_proved) return {};
  finding.nodes = {{first}};
  finding.disproved = finding.withdrawn = finding.begins_segment = is_elsewhere;
  finding.trusted = true;
  forget();
  suspect_from_ = map.graph.nodes.size() + MapperTuning::kSuspectReach;
  if (is_elsewhere) {
    begin(first, Doubt::kAll);
    schedule(map.graph.nodes.size(), false);
    was_found_ = true;
  }
  return finding;
}

SegmentFinding SegmentSearch::placed(const PlaceAnswers& answers, const Map& map) const {
  SegmentFinding finding;
  for (const FoundPlace& answer : answers.all()) finding.closures.push_back(finder_.closure(answer, map));
  const FoundPlace& newest = answers.newest();
  const Pose2& T_map_node = map.graph.nodes[newest.node].pose;
  finding.disproved = !agree({newest.node, T_map_node, newest.covariance}, newest, Pose2{});
  if (finding.disproved) finding.T_new_old = newest.T_map_node * inverse(T_map_node);
  return finding;
}

std::vector<SegmentFinding> SegmentSearch::look_for_all(const Map& map, const TrajectorySegments& segments,
                                                        WorkBudget& budget) {
  const std::uint64_t count = map.graph.nodes.size();
  const std::vector<std::uint64_t> parts = closed_parts(map.graph, segments);
  const std::uint64_t main = largest_part(parts, count);
  std::vector<SegmentFinding> findings;
  const std::vector<std::uint64_t> main_nodes = nodes_of(parts, main, count);
  if (main_nodes.size() == count || budget.is_spent() || !finder_.use(map, main_nodes, true, &budget)) return findings;
  std::vector<std::uint64_t> found;  // parts
  for (const NodeRange& segment : most_doubtful_first(map, segments, parts, main, budget)) {
    const std::uint64_t part = parts[segment.begin];
    if (std::count(found.begin(), found.end(), part) > 0) continue;
    SegmentFinding finding = look_for(segment, map, segments, budget);
    if (finding.is_nothing()) continue;
    finding.nodes = ranges_of(parts, part);
    findings.push_back(finding);
    found.push_back(part);
  }
  return findings;
}

/// The segments of other parts than the main one: those of which nothing tells where they are, then those with the most
/// looks that contradict where odometry has them.
std::vector<NodeRange> SegmentSearch::most_doubtful_first(const Map& map, const TrajectorySegments& segments,
                                                          const std::vector<std::uint64_t>& parts, std::uint64_t main,
                                                          WorkBudget& budget) const {
  std::vector<std::uint64_t> placed(parts.size());
  std::iota(placed.begin(), placed.end(), std::uint64_t{0});
  join_parts(map.graph, MapTuning::kMaxPlacedDeviation, placed);
  std::vector<std::pair<double, NodeRange>> ranked;
  for (std::uint64_t begin = 0; begin < parts.size(); begin = segments.segment_end(begin)) {
    const NodeRange segment{begin, segments.segment_end(begin)};
    if (parts[begin] == main || segment.end - begin < MapperTuning::kFirstSearch) continue;
    const bool is_placed = placed[begin] == placed[main];
    const double doubt = is_placed ? contradicting_share(segment, map, segments, budget) : 1.0;
    if (doubt > 0.0) ranked.emplace_back(-doubt, segment);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<NodeRange> sorted;
  sorted.reserve(ranked.size());
  for (const auto& [doubt, segment] : ranked) sorted.push_back(segment);
  return sorted;
}

double SegmentSearch::contradicting_share(const NodeRange& segment, const Map& map, const TrajectorySegments& segments,
                                          WorkBudget& budget) const {
  const std::vector<std::uint64_t> nodes = nodes_to_look_for(segment);
  const auto contradicts = [&](std::uint64_t node) {
    return finder_.fit(map, segments, segment.begin, node, &budget).contradicts;
  };
  return static_cast<double>(std::count_if(nodes.begin(), nodes.end(), contradicts)) /
         static_cast<double>(nodes.size());
}

/// Looks for a segment by what was seen on all of it. One that is not found stays where odometry leads, even where that
/// contradicts the map: a bent map does so too.
SegmentFinding SegmentSearch::look_for(const NodeRange& segment, const Map& map, const TrajectorySegments& segments,
                                       WorkBudget& budget) const {
  PlaceAnswers answers;
  for (const std::uint64_t node : nodes_to_look_for(segment)) {
    if (budget.is_spent()) return {};
    const Look look = finder_.find(map, segments, segment.begin, node, &budget);
    if (!look.answer) continue;
    answers.add(*look.answer, map);
    if (are_enough(answers, map)) return placed(answers, map);
  }
  return {};
}

}  // namespace oort
