// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "oort/loop_closure/statistics.hpp"
#include "oort/map/map.hpp"

namespace oort {

/// Moves the nodes of a solved map so that scans that saw the same surfaces agree (docs/refinement.md). Poses change by
/// what the scans show, within what the edges of the graph leave open; edges and switches stay as they are. The first
/// node of each connected part stays where it is. Work is bounded by counts; the same map gives the same bits.
///
/// Nodes with a flag in `held`, which may be shorter than the map, stay, too. The map must be one that find_defect()
/// accepts. Returns what was done; a map that the scans would make disagree more is left as it was.
RefinementCounts refine(Map& map, const std::vector<bool>& held = {});

}  // namespace oort
