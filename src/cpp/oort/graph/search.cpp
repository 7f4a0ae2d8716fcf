// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/search.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "oort/graph/graph.hpp"
#include "oort/graph/tuning.hpp"

namespace oort {
namespace {

/// The part of the cost of the edges that are always believed.
double believed_cost(const GraphSolver& solver) {
  double sum = 0.0;
  for (const SolverEdge& edge : solver.edges()) {
    if (!edge.switchable) sum += solver.squared_error(edge);
  }
  return 0.5 * sum;
}

/// The squared error of an edge against what it takes to doubt it.
double strain(const GraphSolver& solver, const SolverEdge& edge) {
  return solver.squared_error(edge) / edge.firmness;
}

bool is_firm(const SolverEdge& edge) {
  return edge.firmness > 1.0;
}

/// The poses that follow from the edges that are always believed alone: each node where the most certain of its edges
/// to earlier nodes has it.
std::vector<Pose2> chained_poses(const GraphSolver& solver) {
  std::vector<Pose2> poses = solver.poses();
  std::vector<const SolverEdge*> best(poses.size(), nullptr);
  const auto certainty = [](const SolverEdge& edge) { return std::abs(edge.W.determinant()); };
  for (const SolverEdge& edge : solver.edges()) {
    const SolverEdge*& chosen = best[std::max(edge.i, edge.j)];
    if (!edge.switchable && (chosen == nullptr || certainty(edge) > certainty(*chosen))) chosen = &edge;
  }
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (solver.is_held(k) || best[k] == nullptr) continue;
    const SolverEdge& edge = *best[k];
    poses[k] = k == edge.j ? poses[edge.i] * edge.T_i_j : poses[edge.j] * inverse(edge.T_i_j);
  }
  return poses;
}

}  // namespace

double robust_cost(const GraphSolver& solver) {
  double sum = 0.0;
  for (const SolverEdge& edge : solver.edges()) {
    const double chi2 = solver.squared_error(edge);
    sum += edge.switchable ? chi2 * solver.best_switch(edge, chi2) : chi2;
  }
  return 0.5 * sum;
}

void Search::run(bool decides) {
  const std::vector<std::size_t> surprising = large_innovations();
  if (!surprising.empty()) switch_all_on();
  if (!decides) {
    solve_switches(0.0, GraphTuning::kTolerance, max_iterations_, max_iterations_);
    return;
  }
  if (!surprising.empty()) find_best_start(surprising);
  decide();
}

/// The edges that were on and are far off at the poses as they are; firm ones, farther than they already were.
std::vector<std::size_t> Search::large_innovations() const {
  std::vector<std::size_t> surprising;
  for (std::size_t k = 0; k < solver_.edges().size(); ++k) {
    const SolverEdge& edge = solver_.edges()[k];
    if (!edge.switchable || edge.s <= agreeing_switch(edge)) continue;
    const double known = is_firm(edge) ? solver_.squared_error_at(edge, edge.s) : 0.0;
    if (solver_.squared_error(edge) > GraphTuning::kLargeInnovation + known) surprising.push_back(k);
  }
  return surprising;
}

/// The switch of an edge that just agrees.
double Search::agreeing_switch(const SolverEdge& edge) const {
  return solver_.best_switch(edge, GraphTuning::kAgreement * edge.firmness);
}

void Search::switch_all_on() {
  for (std::size_t k = 0; k < solver_.edges().size(); ++k) solver_.set_switch(k, 1.0);
}

/// From the poses as they are, and from those of the trajectory alone, which false edges have not bent yet; from the
/// better ones with firm edges believed; then once more, without the edges that are off there, so that those in doubt
/// get a second chance. Last, each of the newest that surprised and are off is believed: a trajectory that must bend
/// far has not bent before the pull of a switch has faded.
void Search::find_best_start(const std::vector<std::size_t>& surprising) {
  std::vector<Pose2> best = solver_.poses();
  double least = robust_cost(solver_);
  const auto try_from = [&](std::vector<Pose2> start, double least_switch,
                            const std::vector<std::size_t>& believed = {}, int steps = GraphTuning::kSearchSteps) {
    solver_.set_poses(std::move(start));
    switch_all_on();
    believe(believed, true);
    solve_switches(least_switch, GraphTuning::kSearchTolerance, steps, GraphTuning::kSearchRounds);
    believe(believed, false);
    if (const double reached = robust_cost(solver_); reached < least) {
      least = reached;
      best = solver_.poses();
    }
  };
  std::vector<Pose2> dead_reckoned = chained_poses(solver_);
  const bool is_chain = believed_cost(solver_) < GraphTuning::kNoCost;
  try_from(best, 0.0);
  if (!is_chain && !is_dear_) try_from(std::move(dead_reckoned), 0.0);
  const std::vector<SolverEdge>& edges = solver_.edges();
  std::vector<std::size_t> firm;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (edges[k].switchable && is_firm(edges[k])) firm.push_back(k);
  }
  if (!firm.empty()) try_from(best, GraphTuning::kOffWhileSearching, firm);
  try_from(best, GraphTuning::kOffWhileSearching);
  std::size_t tries = is_dear_ ? GraphTuning::kBelieved : 0;
  for (auto k = surprising.rbegin(); k != surprising.rend() && tries < GraphTuning::kBelieved; ++k) {
    solver_.set_poses(best);
    if (2.0 * solver_.best_switch(edges[*k], solver_.squared_error(edges[*k])) > 1.0) continue;  // is on
    const int limit = max_iterations_, spent = iterations_;
    max_iterations_ = spent + GraphTuning::kBelievedSteps;
    try_from(best, GraphTuning::kOffWhileSearching, {*k}, GraphTuning::kBelievedSteps);
    max_iterations_ = limit + iterations_ - spent;  // what else there is to do has as many as without
    ++tries;
  }
  solver_.set_poses(std::move(best));
}

/// Makes some edges part of what is always believed, or no longer.
void Search::believe(const std::vector<std::size_t>& edges, bool believe) {
  for (const std::size_t k : edges) solver_.set_switchable(k, !believe);
}

/// With the edges whose best switch is at least this, then with those that are not off.
void Search::solve_switches(double least_switch, double tolerance, int most_steps, int most_rounds) {
  std::vector<bool> on;
  for (const SolverEdge& edge : solver_.edges()) {
    on.push_back(!edge.switchable || solver_.best_switch(edge, solver_.squared_error(edge)) >= least_switch);
  }
  solver_.use(on);
  is_dear_ = solver_.fill() >= GraphTuning::kExpensiveBlocks;
  converge(tolerance, GraphTuning::kFirstSteps);
  const auto is_not_off = [this](const SolverEdge& edge, int) {
    return solver_.best_switch(edge, solver_.squared_error(edge)) >= GraphTuning::kOffWhileSearching;
  };
  settle(is_not_off, tolerance, most_steps, most_rounds);
}

/// Leaves out the edges that disagree, until those that are left agree with each other.
void Search::decide() {
  const auto agrees = [this](const SolverEdge& edge, int round) {
    const double doubt = strain(solver_, edge);
    if (round == 0 && edge.s > agreeing_switch(edge)) {
      return doubt <= GraphTuning::kLargeInnovation;  // may pull before it is judged
    }
    return doubt <= GraphTuning::kAgreement && (round < GraphTuning::kRoundsBothWays || edge.on);
  };
  settle(agrees, GraphTuning::kTolerance, max_iterations_, max_iterations_);
}

/// Solves with the edges that the rule chooses, again and again until they stay the same.
template <typename Rule>
void Search::settle(const Rule& takes_part, double tolerance, int most_steps, int most_rounds) {
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<bool> on;
    for (std::size_t k = 0; k < solver_.edges().size(); ++k) {
      const SolverEdge& edge = solver_.edges()[k];
      on.push_back(!edge.switchable || takes_part(edge, round));
      if (edge.switchable) solver_.set_switch(k, solver_.best_switch(edge, solver_.squared_error(edge)));
    }
    if (!solver_.use(on) && round > 0) return;
    converge(tolerance, most_steps);
  }
}

void Search::converge(double tolerance, int most_steps) {
  progress_ = GraphSolver::Progress::kMoved;
  for (int k = 0; k < most_steps && iterations_ < max_iterations_; ++k) {
    progress_ = solver_.step(tolerance);
    ++iterations_;
    if (progress_ != GraphSolver::Progress::kMoved) return;
  }
}

}  // namespace oort
