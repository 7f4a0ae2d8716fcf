// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "oort/loop_closure/statistics.hpp"
#include "oort/map/map.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// Two nodes of segments that nothing has linked yet, at about their places.
struct Joint {
  std::uint64_t before = 0;  ///< a node before `begin`
  std::uint64_t after = 0;   ///< a node from `begin` on
};

/// Closes loops from the nodes from `begin` on to those before it, as if the former were driven only now: from the
/// joint outwards along their segments, the graph solved after each closure with a large innovation. Adds the closures
/// to the map, and a wide edge at the joint; the map's poses are then those of an intermediate solution. Returns what
/// became of the attempts.
ClosureCounts close_across(Map& map, std::uint64_t begin, const Joint& joint, const Parameters& parameters);

}  // namespace oort
