// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/segment_search.hpp"

#include <algorithm>

#include "oort/maintenance/tied_segments.hpp"
#include "oort/map/parts.hpp"
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

/// The part that has the most of the first `count` nodes; of equal ones the oldest.
std::uint64_t largest_part(const std::vector<std::uint64_t>& parts, std::uint64_t count) {
  std::vector<std::uint64_t> sizes(parts.size(), 0);
  for (std::uint64_t node = 0; node < count; ++node) ++sizes[parts[node]];
  return static_cast<std::uint64_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
}

std::vector<std::uint64_t> nodes_of(const std::vector<std::uint64_t>& parts, std::uint64_t part, std::uint64_t count) {
  std::vector<std::uint64_t> nodes;
  for (std::uint64_t node = 0; node < count; ++node) {
    if (parts[node] == part) nodes.push_back(node);
  }
  return nodes;
}

/// What closures alone hold together: odometry may be wrong wherever a new local map was begun.
std::vector<std::uint64_t> closed_parts(const Graph& graph, const TrajectorySegments& segments) {
  std::vector<std::uint64_t> parts(graph.nodes.size());
  for (std::uint64_t node = 0; node < parts.size(); ++node) parts[node] = segments.segment_begin(node);
  join_parts(graph, 0.0, parts);
  return parts;
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

Pose2 driven(const Map& map, const FoundPlace& from, const FoundPlace& to) {
  return between(map.graph.nodes[from.node].pose, map.graph.nodes[to.node].pose);
}

/// Whether the answers come from so far apart that they are no repetitions of each other.
bool are_enough(const std::vector<FoundPlace>& answers, const Map& map) {
  return answers.size() >= MapperTuning::kAgreeingAnswers &&
         driven(map, answers.front(), answers.back()).translation().norm() >= MapperTuning::kAnswersApart;
}

/// Keeps of the answers those that agree with a new one, and adds it.
void add_answer(std::vector<FoundPlace>& answers, const FoundPlace& answer, const Map& map) {
  const auto disagrees = [&](const FoundPlace& other) { return !agree(other, answer, driven(map, other, answer)); };
  answers.erase(std::remove_if(answers.begin(), answers.end(), disagrees), answers.end());
  const bool is_new =
      answers.empty() || driven(map, answers.back(), answer).translation().norm() >= MapperTuning::kAnswerTravel;
  if (is_new) answers.push_back(answer);
}

}  // namespace

void SegmentSearch::begin(std::uint64_t first_node, bool is_unknown) {
  first_ = first_node;
  due_ = first_node + (is_unknown ? MapperTuning::kFirstSearch : MapperTuning::kFirstSearchNearby);
  was_found_ = false;
  is_unknown_ = is_unknown;
  is_distrusted_ = false;
  looks_tied_ = contradictions_ = 0;
  answers_.clear();
}

SegmentFinding SegmentSearch::look(const Map& map, const TrajectorySegments& segments, WorkMeter* meter) {
  const std::uint64_t count = map.graph.nodes.size(), newest = count - 1;
  const std::uint64_t parts_grown = is_unknown_ ? MapperTuning::kSearchGrowthParts : MapperTuning::kDoubtGrowthParts;
  due_ = count + std::max(MapperTuning::kLeastSearchSpacing, (count - *first_) / parts_grown);
  if (!is_unknown_) first_ = first_doubtful(segments, *first_);
  const std::uint64_t first = *first_;
  const bool is_tied = oort::is_tied(map.graph, first);
  // Where odometry is merely doubted, closures near by may be believed: they were looked for where it says.
  if (first == 0 || is_docked(map.graph, first) || (is_tied && !is_unknown_ && !was_found_)) {
    forget();
    return {};
  }
  const std::vector<std::uint64_t> parts = tied_parts(map.graph, segments);
  const std::uint64_t main = largest_part(parts, first);
  if (!finder_.use(map, nodes_of(parts, main, first), is_unknown_, meter)) {
    forget();
    return {};
  }
  weigh_tie(is_tied, finder_.contradicts(map, segments, first, newest, meter));
  if (is_tied && contradictions_ >= MapperTuning::kContradictions && 2 * contradictions_ >= looks_tied_) {
    begin(first, true);
    is_distrusted_ = true;
    due_ = count + MapperTuning::kLeastSearchSpacing;
    return {{{first}}, true, true, {}, {}};
  }
  const std::optional<FoundPlace> answer = finder_.find(map, segments, first, newest, meter);
  return answer ? take(*answer, first, map) : SegmentFinding{};
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
  add_answer(answers_, answer, map);
  if (!are_enough(answers_, map)) return {};
  SegmentFinding finding = placed(answers_, map);
  answers_.clear();
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

SegmentFinding SegmentSearch::placed(const std::vector<FoundPlace>& answers, const Map& map) const {
  SegmentFinding finding;
  for (const FoundPlace& answer : answers) finding.closures.push_back(finder_.closure(answer, map));
  const FoundPlace& newest = answers.back();
  const Pose2& T_map_node = map.graph.nodes[newest.node].pose;
  finding.disproved = !agree({newest.node, T_map_node, newest.covariance}, newest, Pose2{});
  if (finding.disproved) finding.T_new_old = newest.T_map_node * inverse(T_map_node);
  return finding;
}

std::vector<SegmentFinding> SegmentSearch::look_for_all(const Map& map, const TrajectorySegments& segments,
                                                        int& looks_left) {
  const std::uint64_t count = map.graph.nodes.size();
  const std::vector<std::uint64_t> parts = closed_parts(map.graph, segments);
  const std::uint64_t main = largest_part(parts, count);
  std::vector<SegmentFinding> findings;
  const std::vector<std::uint64_t> main_nodes = nodes_of(parts, main, count);
  if (main_nodes.size() == count || !finder_.use(map, main_nodes, true, nullptr)) return findings;
  std::vector<std::uint64_t> found;  // parts
  for (std::uint64_t begin = 0; begin < count; begin = segments.segment_end(begin)) {
    const NodeRange segment{begin, segments.segment_end(begin)};
    const std::uint64_t part = parts[begin];
    const bool is_small = segment.end - begin < MapperTuning::kFirstSearch;
    if (part == main || is_small || std::count(found.begin(), found.end(), part) > 0) continue;
    SegmentFinding finding = look_for(segment, map, segments, looks_left);
    if (finding.is_nothing()) continue;
    finding.nodes = ranges_of(parts, part);
    findings.push_back(finding);
    found.push_back(part);
  }
  return findings;
}

/// Looks for a segment by what was seen on all of it. One that is not found stays where odometry leads, even where that
/// contradicts the map: a bent map does so too.
SegmentFinding SegmentSearch::look_for(const NodeRange& segment, const Map& map, const TrajectorySegments& segments,
                                       int& looks_left) const {
  std::vector<FoundPlace> answers;
  const std::uint64_t step =
      std::max((segment.end - segment.begin) / MapperTuning::kMaxLooks, MapperTuning::kLeastSearchSpacing);
  for (std::uint64_t node = segment.begin + MapperTuning::kFirstSearch - 1; node < segment.end; node += step) {
    if (looks_left-- <= 0) return {};
    const std::optional<FoundPlace> answer = finder_.find(map, segments, segment.begin, node, nullptr);
    if (!answer) continue;
    add_answer(answers, *answer, map);
    if (are_enough(answers, map)) return placed(answers, map);
  }
  return {};
}

}  // namespace oort
