// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"

namespace oort {

/// Takes out of the clouds of the nodes before `first_new` the beams that the nodes from there on contradict: returns
/// from what is no longer there, and beams through what stands there now (docs/lifelong.md). Several nodes must agree,
/// and where they see a surface at all none is taken out; nodes that no closure ties to the older ones have no say.
/// Returns how many beams were taken out.
std::size_t remove_outdated(Map& map, const TrajectorySegments& segments, std::uint64_t first_new);

}  // namespace oort
