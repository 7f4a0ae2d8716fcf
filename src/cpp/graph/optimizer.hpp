// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "oort/graph/graph.hpp"

namespace oort {

/// How an error e is weighted by its information matrix = L L^T.
enum class Whitening {
  kCorrect,   ///< L^T e, so that |L^T e|^2 = e^T information e
  kOriginal,  ///< L e, as Mayfield's Oort did: its maps' poses are the optimum of this weighting
};

struct OptimizerOptions {
  /// What it costs to switch a link off: a link whose squared Mahalanobis distance equals this is half switched off.
  double switchable_constraint_scale = 2.0;
  Whitening whitening = Whitening::kCorrect;
  int max_iterations = 50;
};

struct OptimizerSummary {
  bool converged = false;
  int iterations = 0;
  double initial_cost = 0.0;  ///< half the sum of squared residuals
  double final_cost = 0.0;
  std::string message;  ///< why the solver stopped
};

/// Moves the nodes and sets the switches to the least-squares optimum of all links (residuals.hpp).
///
/// Starts from the graph's own poses and switch values. The first node of the graph, and the first of every part that
/// no edge links to it, keeps its pose. Deterministic: the same graph gives the same bits.
/// If the solver stops at max_iterations the graph holds the best poses so far; if the solver fails the graph is left
/// as it was; `converged` is false in both cases.
/// InputError, with the graph untouched, if a node, an edge or an option cannot be used; the message names it.
OptimizerSummary optimize(Graph& graph, const OptimizerOptions& options);

}  // namespace oort
