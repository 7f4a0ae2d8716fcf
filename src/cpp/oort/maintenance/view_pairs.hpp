// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <utility>
#include <vector>

#include "oort/geometry/pose2.hpp"
#include "oort/maintenance/surface_pieces.hpp"

namespace oort {

/// Two nodes, the earlier first.
using ViewPair = std::pair<std::size_t, std::size_t>;

/// Which nodes are likely to have seen the same surfaces: each with up to eight earlier ones, those for which the
/// middle of what they saw lies nearest, spread out along the drive. `poses` are T_map_sensor; `pieces` what each node
/// saw, in its sensor's frame.
std::vector<ViewPair> view_pairs(const std::vector<Pose2>& poses, const std::vector<std::vector<SurfacePiece>>& pieces);

}  // namespace oort
