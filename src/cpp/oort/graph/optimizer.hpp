// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "oort/geometry/work_meter.hpp"
#include "oort/graph/graph.hpp"

namespace oort {

/// How an error e is weighted by its information matrix = L L^T.
enum class Whitening {
  kCorrect,   ///< L^T e, so that |L^T e|^2 = e^T information e
  kOriginal,  ///< L e, as Mayfield's Oort did: its maps' poses are the optimum of this weighting
};

/// How a switchable edge that disagrees loses its weight.
enum class RobustKernel {
  kSwitchable,  ///< by its switch: the cost of an edge is at most half of switchable_constraint_scale
  kHuber,       ///< its cost grows in proportion to its error, no longer its square: it keeps pulling, but less
};

struct OptimizerOptions {
  /// What it costs to switch an edge off: an edge whose squared Mahalanobis distance equals this is half switched off.
  double switchable_constraint_scale = 2.0;
  Whitening whitening = Whitening::kCorrect;
  int max_iterations = 50;
  /// Whether edges that disagree with the optimum of the switches (at 95 %) are then left out, so that what is false
  /// pulls no more at all. Without it the poses are the optimum of the switchable problem.
  bool decide = true;
  /// Nodes with lower ids keep their poses: solving is then about the newest nodes only, and costs as much as they do.
  std::uint64_t first_free_node = 0;
  RobustKernel robust_kernel = RobustKernel::kSwitchable;
  /// Standard deviations from which on an edge's cost is no longer squared; for kHuber.
  double huber_scale = 10.0;
  /// Who counts the work while it is done; may be null. With kHuber it is charged beforehand as a whole.
  WorkMeter* meter = nullptr;
  /// Nodes that keep their poses besides those before first_free_node: a flag for each, none for the last ones.
  std::vector<bool> held = {};

  bool holds(std::uint64_t node) const { return node < first_free_node || (node < held.size() && held[node]); }
};

/// Throws ParameterError.
void check_options(const OptimizerOptions& options);

struct OptimizerSummary {
  bool converged = false;
  int iterations = 0;
  /// Half the sum of chi^2 over the edges and of scale chi^2 / (scale + chi^2) over the switchable edges, where chi^2
  /// is an edge's squared Mahalanobis distance and scale counts as often as the edge is firm; before and after. With
  /// kHuber a switchable edge adds half of chi^2 up to huber_scale^2, and of 2 huber_scale chi - huber_scale^2 beyond.
  double initial_cost = 0.0;
  double final_cost = 0.0;
  /// chi^2 of each switchable edge at the final poses.
  std::vector<double> chi_squared;
  std::string message;  ///< why the solver stopped
};

/// Moves the nodes to the optimum of all edges, however many of the switchable ones are false, and sets the switches:
/// scale / (scale + chi^2), the least costly with the final poses; scale is as many times larger as an edge is firm.
/// With kHuber switches only tell what became of an edge: s^2 is the share of its weight that is left, min(1,
/// huber_scale / chi); nothing is decided.
///
/// Starts from the graph's own poses and switch values (docs/optimiser.md). The first node of the graph, and the first
/// of every part that no edge links to it, keeps its pose. Deterministic: one thread; the same graph gives the same
/// bits. If the solver stops at max_iterations the graph holds the best poses so far and `converged` is false.
/// InputError, with the graph untouched, if a node, an edge or an option cannot be used; the message names it.
OptimizerSummary optimize(Graph& graph, const OptimizerOptions& options);

}  // namespace oort
