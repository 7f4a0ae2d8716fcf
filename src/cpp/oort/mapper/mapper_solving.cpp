// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// When a Mapper solves its graph, how much of it, and what it makes of the solution.
#include <algorithm>
#include <utility>

#include "oort/maintenance/refinement.hpp"
#include "oort/mapper/mapper.hpp"

namespace oort {
namespace {

// What does not surprise waits until the graph has grown by a twentieth, so that the work of all solves together stays
// in proportion to the graph.
constexpr std::uint64_t kMinSolveInterval = 10;
constexpr std::uint64_t kSolveGrowth = 20;

// In a larger graph, a surprise is first solved by moving so many of the newest nodes.
constexpr std::uint64_t kNewestNodes = 1000;

constexpr int kFinalIterations = 100;

}  // namespace

void Mapper::finish() {
  {
    const WorkClock clock(work_seconds_.matching);
    add_closures(loops_.work_off(map_, chains_, statistics_.loops, closure_log_));
  }
  if (pending_closures_ > 0 || !map_.graph.switchable_edges.empty()) solve_anew(kFinalIterations);
  if (parameters_.final_refinement) statistics_.refinement = refine(map_);
}

void Mapper::solve_if_worthwhile(double surprise) {
  if (pending_closures_ == 0) return;
  const std::uint64_t nodes = map_.graph.nodes.size();
  const std::uint64_t interval = std::max(kMinSolveInterval, nodes / kSolveGrowth);
  if (nodes >= nodes_at_last_solve_ + interval) {
    solve(kIterationsWhileMapping);
  } else if (surprise > kSurprise) {
    if (nodes <= kNewestNodes || !solve_newest()) solve(kIterationsWhileMapping);
  } else {
    return;
  }
  look_at_solution();
}

// Moves the newest nodes alone, which costs the same however large the map is. False if most of the new closures still
// disagree: what they say is about the nodes before, too.
bool Mapper::solve_newest() {
  const std::uint64_t closures = pending_closures_;
  const std::uint64_t solved_before = nodes_at_last_solve_;
  std::vector<double> chi2 = solve(kIterationsWhileMapping, map_.graph.nodes.size() - kNewestNodes).chi_squared;
  nodes_at_last_solve_ = solved_before;
  const auto disagrees = [](double value) { return value > kAgreement; };
  return 2 * std::count_if(chi2.end() - static_cast<std::ptrdiff_t>(closures), chi2.end(), disagrees) <=
         static_cast<std::ptrdiff_t>(closures);
}

// Links that an earlier false closure had switched off stay off, as nothing pulls at a switch that is 0. So the whole
// graph is solved once more with all of them on, and the better of the two solutions counts.
void Mapper::solve_anew(int max_iterations) {
  const double cost = solve(max_iterations).final_cost;
  Graph kept = map_.graph;
  for (SwitchableEdge& edge : map_.graph.switchable_edges) edge.switch_value = 1.0;
  if (solve(max_iterations).final_cost >= cost) map_.graph = std::move(kept);
  look_at_solution();
}

OptimizerSummary Mapper::solve(int max_iterations, std::uint64_t first_free_node) {
  const WorkClock clock(work_seconds_.solving);
  OptimizerOptions options = optimizer_options(parameters_, max_iterations);
  options.first_free_node = first_free_node;
  const OptimizerSummary summary = optimize(map_.graph, options);
  ++statistics_.solves;
  if (!summary.converged) ++statistics_.solves_cut_short;
  pending_closures_ = 0;
  nodes_at_last_solve_ = map_.graph.nodes.size();
  return summary;
}

// Closures are counted by what the latest solution says of them: kept, contradicted, or kept again.
void Mapper::look_at_solution() {
  const std::vector<SwitchableEdge>& closures = map_.graph.switchable_edges;
  is_on_.resize(closures.size(), true);
  statistics_.solved.kept = 0;
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const bool on = closures[k].is_on();
    if (on && !is_on_[k]) ++statistics_.solved.came_back;
    if (on) ++statistics_.solved.kept;
    is_on_[k] = on;
  }
  statistics_.solved.contradicted = closures.size() - statistics_.solved.kept;
  if (!map_.graph.nodes.empty()) {
    tracking_.look_for_tie(map_.graph, chains_.segment_begin(map_.graph.nodes.back().id));
  }
}

}  // namespace oort
