// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
// Internal to the optimiser.
#include <cstddef>
#include <vector>

#include "oort/graph/graph_solver.hpp"

namespace oort {

/// Half the sum of chi^2 over the edges that are always believed and of scale chi^2 / (scale + chi^2), the least that a
/// switch can make of it, over the others.
double robust_cost(const GraphSolver& solver);

/// The search for the solution (docs/optimiser.md).
///
/// If no edge that was on has a large innovation, all that is left to do is to decide anew which agree. Else what was
/// believed may be wrong: all switches start at 1 again, so that edges that were off together can come back together; a
/// solution that costs more than the poses that were there is dropped.
class Search {
 public:
  Search(GraphSolver& solver, int max_iterations) : solver_(solver), max_iterations_(max_iterations) {}

  /// To the optimum of the switches; if `decide`, edges that disagree with it are then left out.
  void run(bool decide);

  int iterations() const { return iterations_; }
  GraphSolver::Progress progress() const { return progress_; }

 private:
  std::vector<std::size_t> large_innovations() const;
  double agreeing_switch(const SolverEdge& edge) const;
  void switch_all_on();
  void find_best_start(const std::vector<std::size_t>& surprising);
  void believe(const std::vector<std::size_t>& edges, bool believe);
  void solve_switches(double least_switch, double tolerance, int most_steps, int most_rounds);
  void decide();
  template <typename Rule>
  void settle(const Rule& takes_part, double tolerance, int most_steps, int most_rounds);
  void converge(double tolerance, int most_steps);

  GraphSolver& solver_;
  int max_iterations_;
  int iterations_ = 0;
  bool is_dear_ = false;
  GraphSolver::Progress progress_ = GraphSolver::Progress::kMoved;
};

}  // namespace oort
