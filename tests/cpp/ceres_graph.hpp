// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "oort/graph/graph.hpp"

namespace oort {

/// What the optimiser is compared with: the same least-squares problem, written down afresh and solved by Ceres with
/// automatic derivatives. Moves the nodes, but for the first, and sets the switches.
void solve_with_ceres(Graph& graph, double scale);

}  // namespace oort
