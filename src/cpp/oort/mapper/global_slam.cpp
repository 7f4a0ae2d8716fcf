// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/global_slam.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "oort/graph/tuning.hpp"
#include "oort/maintenance/outdated.hpp"
#include "oort/maintenance/refinement.hpp"
#include "oort/map/tuning.hpp"
#include "oort/mapper/tuning.hpp"

namespace oort {
namespace {

/// Whether nothing at all is known of where a node lies that begins a segment.
bool is_unknown(const NodeAddition& node) {
  const Eigen::Matrix3d& covariance = node.edges.front().constraint.covariance;
  return std::max(covariance(0, 0), covariance(1, 1)) > MapTuning::kMaxPlacedDeviation * MapTuning::kMaxPlacedDeviation;
}

}  // namespace

GlobalSlam::GlobalSlam(const Parameters& parameters)
    : parameters_(parameters),
      loops_(parameters),
      docks_(parameters),
      segment_search_(parameters),
      drift_search_(parameters, loops_.search()) {
  begin_session();
}

void GlobalSlam::set_map(const Map& map) {
  map_.set_map(map);
  make_dock_closures_firm(map_.edit(), parameters_.dock_graph_builder.closure_firmness);
  begin_session();
  dock_requests_.clear();
  begin_schedule();
}

void GlobalSlam::begin_session() {
  loops_ = LoopClosureBuilder(parameters_);
  to_look_from_ = LookQueue();
  session_begin_ = map_.node_count();
  former_.reset();
  former_stays_ = former_gave_way_ = false;
  segment_search_ = SegmentSearch(parameters_);
  drift_search_ = DriftSearch(parameters_, loops_.search());
  drift_search_.begin(map_.segments());
  watch_.forget();
  reduction_ = {std::max(MapperTuning::kFirstReduction, MapperTuning::kReductionGrowth * map_.node_count()), false};
}

void GlobalSlam::begin_schedule() {
  schedule_ = SolveSchedule();
  schedule_.solved_all(map_.node_count());
  is_on_.clear();
  count_switches();
}

void GlobalSlam::add(const NodeAddition& node) {
  to_look_from_.add(map_.node_count());
  if (node.begins_segment && !node.edges.empty()) {
    segment_search_.begin(map_.node_count(), is_unknown(node) ? Doubt::kAll : Doubt::kOdometry);
  }
  map_.add(node);
}

bool GlobalSlam::has_work() const {
  return !dock_requests_.empty() || !to_look_from_.empty() || loops_.has_work() ||
         segment_search_.is_due(map_.node_count()) || may_be_drifted() ||
         schedule_.due(map_.node_count(), map_.node_count()) != SolveSchedule::Extent::kNothing || is_reduction_due();
}

Correction GlobalSlam::work(WorkMeter& meter) {
  if (!dock_requests_.empty()) return link_docks(&meter);
  const SolveSchedule::Extent extent = schedule_.due(map_.node_count(), map_.node_count());
  if (extent != SolveSchedule::Extent::kNothing) {
    solve_due(extent, &meter);
    return solved();
  }
  if (is_reduction_due()) return reduce(meter);
  if (segment_search_.is_due(map_.node_count())) {
    const WorkClock clock(work_seconds_.matching);
    return placed(segment_search_.look(map(), map_.segments(), &meter));
  }
  if (may_be_drifted()) {
    const WorkClock clock(work_seconds_.matching);
    return closed(drift_search_.look(map(), map_.segments(), &meter), &meter);
  }
  if (to_look_from_.has_fresh() || (!to_look_from_.empty() && !loops_.has_work())) {
    const WorkClock clock(work_seconds_.candidates);
    const auto [node, is_new] = to_look_from_.take();
    loops_.look(map(), map_.segments(), node, &meter);
    if (is_new) watch(node, meter);
    return nothing();
  }
  const WorkClock clock(work_seconds_.matching);
  return found(trusted(loops_.work(map(), map_.segments(), counts_.loops, closure_log_, &meter)));
}

/// While there is nothing else to do; later, for want of such a time.
bool GlobalSlam::is_reduction_due() const {
  if (parameters_.keep_views == 0 || reduction_.is_under_way) return false;
  const bool is_busy = segment_search_.is_looking() || !to_look_from_.empty() || loops_.has_work();
  return map_.node_count() >= (is_busy ? reduction_.due + reduction_.due / 2 : reduction_.due);
}

/// A session that goes on and on is ended and gone on with beside the scans (docs/lifelong.md): the map is solved,
/// scans are made to agree, what is out of date goes, and so do views that show what others do.
Correction GlobalSlam::reduce(WorkMeter& meter) {
  const std::uint64_t size = map_.node_count();
  const double share = session_begin_ == 0 ? MapperTuning::kMinFirstReducedShare : MapperTuning::kMinReducedShare;
  PruneOptions options{static_cast<unsigned>(parameters_.keep_views), share, MapperTuning::kUnsettledNodes};
  charge(&meter, MapperTuning::kWorkPerView * static_cast<double>(size));
  if (!prune(map(), map_.segments(), options)) {
    reduction_.due = size + size / 2;
    return nothing();
  }
  charge(&meter, MapperTuning::kWorkPerReduced * static_cast<double>(size));
  former_gave_way_ = false;
  solve_anew(MapperTuning::kIterations, &meter);
  if (parameters_.final_refinement) counts_.refinement = refine(map_.edit(), held());
  remove_outdated(map_.edit(), map_.segments(), session_begin_);
  options.min_share = 0.0;
  std::optional<Pruned> pruned = prune(map(), map_.segments(), options);
  if (!pruned) {  // closures that it cost moved what looked alike
    reduction_.due = size + size / 2;
    Correction correction = solved();
    correction.clouds = map().clouds;
    return correction;
  }
  go_on_with(*pruned, size);
  Correction correction = nothing();
  correction.reduced = std::make_shared<const Pruned>(std::move(*pruned));
  return correction;
}

void GlobalSlam::go_on_with(const Pruned& pruned, std::uint64_t size) {
  map_.reduce(pruned.map, pruned.nodes);
  closure_log_.renumber(pruned.nodes);
  const std::uint64_t settled = parameters_.frozen_map ? session_begin_ : size - MapperTuning::kUnsettledNodes;
  const LookQueue to_look_from = to_look_from_.renumbered(pruned.nodes);
  begin_session();
  to_look_from_ = to_look_from;
  begin_schedule();
  session_begin_ = pruned.nodes.left_before(settled);
  reduction_.is_under_way = true;
}

Correction GlobalSlam::link_docks(WorkMeter* meter) {
  Correction all;
  for (; !dock_requests_.empty(); dock_requests_.pop_front()) {
    std::optional<Closure> closure;
    {
      const WorkClock clock(work_seconds_.matching);
      closure = docks_.find(map(), map_.segments(), dock_requests_.front(), counts_.docks, meter);
    }
    all.docked.push_back(closure.has_value());
    if (!closure) continue;
    found({*closure});
    all.closures.push_back(*closure);
  }
  if (!all.closures.empty()) {
    solve_anew(MapperTuning::kIterations, meter);
    all.solution = map_.solution();
  }
  all.counts = counts_;
  return all;
}

/// But counts.
Correction GlobalSlam::nothing() const {
  Correction correction;
  correction.counts = counts_;
  return correction;
}

Correction GlobalSlam::found(const std::vector<Closure>& closures) {
  for (const Closure& closure : closures) schedule_.add_closure(map_.add(closure));
  Correction correction = nothing();
  correction.closures = closures;
  return correction;
}

std::vector<Closure> GlobalSlam::trusted(std::vector<Closure> closures) const {
  const auto refused = [this](const Closure& closure) { return segment_search_.refuses(closure); };
  closures.erase(std::remove_if(closures.begin(), closures.end(), refused), closures.end());
  return closures;
}

void GlobalSlam::watch(std::uint64_t node, WorkMeter& meter) {
  watch_.look(map(), node, &meter);
  const std::optional<std::uint64_t> first = watch_.first_suspect();
  if (!first) return;
  segment_search_.suspect(*first, map_.segments());
  watch_.forget();
}

Correction GlobalSlam::placed(const SegmentFinding& finding) {
  if (finding.is_nothing()) return nothing();
  if (finding.withdrawn) {
    map_.withdraw_ties(finding.nodes);
    is_on_.clear();
    count_switches();
  }
  if (finding.begins_segment) {
    map_.begin_segment(finding.nodes.front().begin);
    forget_submaps();
  }
  if (finding.disproved) {
    map_.loosen(finding.nodes);
    watch_.forget();
  }
  Correction correction = found(finding.closures);
  if (finding.disproved || finding.trusted) correction.segments = {finding};
  if (!finding.disproved || finding.closures.empty()) return correction;
  // Solving begins where the closures say: from elsewhere it would rather switch them off.
  for (Node& node : map_.edit().graph.nodes) {
    if (!contains(finding.nodes, node.id)) continue;
    node.pose = finding.T_new_old * node.pose;
    to_look_from_.add(node.id);
  }
  correction.solution = map_.solution();
  return correction;
}

/// Where nothing tells where the robot is, it is looked for everywhere (SegmentSearch).
bool GlobalSlam::may_be_drifted() const {
  return !segment_search_.is_lost() && drift_search_.is_due(map_.segments());
}

/// Closes a loop. What that moves looks for loops again: some were too far off.
Correction GlobalSlam::closed(const std::vector<Closure>& closures, WorkMeter* meter) {
  if (closures.empty()) return nothing();
  const std::vector<Pose2> poses = map_.solution().poses;
  Correction correction = found(closures);
  solve_anew(MapperTuning::kIterations, meter);
  correction.solution = map_.solution();
  correction.counts = counts_;
  const auto is_on = [](const SwitchableEdge& edge) { return edge.is_on(); };
  const auto last = map().graph.switchable_edges.rbegin();
  const auto count = static_cast<std::ptrdiff_t>(closures.size());
  if (std::none_of(last, last + count, is_on)) drift_search_.refuted(map_.segments());
  for (const std::uint64_t node : nodes_to_look_again(map(), map_.segments(), poses)) to_look_from_.add_again(node);
  return correction;
}

Correction GlobalSlam::solved() {
  count_switches();
  Correction correction = nothing();
  correction.solution = map_.solution();
  return correction;
}

void GlobalSlam::solve_due(SolveSchedule::Extent extent, WorkMeter* meter) {
  if (extent == SolveSchedule::Extent::kNewest && solve_newest(meter)) return;
  solve(MapperTuning::kIterations, 0, meter);
  schedule_.solved_all(map_.node_count());
  leave_former(MapperTuning::kIterations, meter);
}

// False if most of the new closures still disagree: what they say is about the nodes before, too.
bool GlobalSlam::solve_newest(WorkMeter* meter) {
  const auto closures = static_cast<std::ptrdiff_t>(schedule_.pending());
  const std::vector<double> chi2 =
      solve(MapperTuning::kIterations, map_.node_count() - MapperTuning::kNewestNodes, meter).chi_squared;
  schedule_.solved_newest();
  const auto disagrees = [](double value) { return value > GraphTuning::kAgreement; };
  return 2 * std::count_if(chi2.end() - closures, chi2.end(), disagrees) <= closures;
}

// Edges that an earlier false closure had switched off stay off, as nothing pulls at a switch that is 0. So the whole
// graph is solved once more with all of them on, and the better of the two solutions counts.
void GlobalSlam::solve_anew(int max_iterations, WorkMeter* meter) {
  const double cost = solve(max_iterations, 0, meter).final_cost;
  Graph& graph = map_.edit().graph;
  Graph kept = graph;
  for (SwitchableEdge& edge : graph.switchable_edges) edge.switch_value = 1.0;
  if (solve(max_iterations, 0, meter).final_cost >= cost) graph = std::move(kept);
  leave_former(max_iterations, meter);
  schedule_.solved_all(map_.node_count());
  count_switches();
}

/// Puts the map that the session goes on with back to where it was, and the session's nodes to where they are then, if
/// what was measured does not speak against it (former_map.hpp).
void GlobalSlam::leave_former(int max_iterations, WorkMeter* meter) {
  Graph& graph = map_.edit().graph;
  former_stays_ = former_ && !former_gave_way_ && former_->keeps_shape(graph);
  if (former_stays_) {
    Graph solved = graph;
    former_->restore(graph);
    OptimizerOptions options = optimizer_options(parameters_, max_iterations);
    options.held = former_->nodes();
    options.meter = meter;
    solve(options);
    const SwitchedOff lost = switched_off(solved, graph, session_begin_);
    former_stays_ = static_cast<double>(lost.off) <=
                    MapperTuning::kMaxLostClosures + MapperTuning::kMaxLostShare * static_cast<double>(lost.of);
    if (!former_stays_) graph = std::move(solved);
  }
  former_gave_way_ = former_ && !former_stays_;
}

/// Nodes that no refinement moves.
std::vector<bool> GlobalSlam::held() const {
  if (parameters_.frozen_map) return std::vector<bool>(session_begin_, true);
  return former_stays_ ? former_->nodes() : std::vector<bool>();
}

OptimizerSummary GlobalSlam::solve(int max_iterations, std::uint64_t first_free_node, WorkMeter* meter) {
  OptimizerOptions options = optimizer_options(parameters_, max_iterations);
  options.first_free_node = std::max(first_free_node, parameters_.frozen_map ? session_begin_ : 0);
  options.meter = meter;
  if (!former_ && !parameters_.frozen_map && session_begin_ > 0 && session_begin_ < map_.node_count()) {
    const WorkClock clock(work_seconds_.solving);
    OptimizerOptions alone = optimizer_options(parameters_, MapperTuning::kIterations);
    alone.meter = meter;
    former_ = FormerMap(map(), map_.segments(), session_begin_, alone);
  }
  // What a few nodes are solved for says nothing of the map.
  if (first_free_node > 0 && former_ && !former_gave_way_) options.held = former_->nodes();
  return solve(options);
}

OptimizerSummary GlobalSlam::solve(const OptimizerOptions& options) {
  const WorkClock clock(work_seconds_.solving);
  OptimizerSummary summary = optimize(map_.edit().graph, options);
  ++counts_.solves;
  if (!summary.converged) ++counts_.solves_cut_short;
  return summary;
}

// Closures are counted by what the latest solution says of them: kept, contradicted, or kept again.
void GlobalSlam::count_switches() {
  const std::vector<SwitchableEdge>& closures = map().graph.switchable_edges;
  is_on_.resize(closures.size(), true);
  counts_.solved.kept = 0;
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const bool on = closures[k].is_on();
    if (on && !is_on_[k]) ++counts_.solved.came_back;
    if (on) ++counts_.solved.kept;
    is_on_[k] = on;
  }
  counts_.solved.contradicted = closures.size() - counts_.solved.kept;
}

}  // namespace oort
