// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/geometry/pose2.hpp"
#include "oort/map/map.hpp"
#include "oort/map/node_addition.hpp"

namespace oort {

/// What became of the nodes of a map that was reduced. Nodes that came after
/// those follow on what is left of them.
struct Renumbering {
  std::vector<bool> kept;  ///< for each node of the map before; so are the others
  /// The node that it became, or by which its place is known now.
  std::vector<std::uint64_t> carrier;
  std::vector<Pose2> T_carrier_node;  ///< the identity where it was kept
  std::uint64_t size = 0;             ///< nodes that are left

  /// Of so many nodes that all stay.
  static Renumbering none(std::uint64_t size);

  std::uint64_t of(std::uint64_t node) const {
    return node < carrier.size() ? carrier[node] : node - carrier.size() + size;
  }
  /// How many of the nodes before this one are left.
  std::uint64_t left_before(std::uint64_t node) const;
};

/// One after the other: the second is of the map that the first left.
Renumbering operator*(const Renumbering& first, const Renumbering& second);

/// A place on the nodes that are left.
Location renumbered(Location location, const Renumbering& nodes);

// What links nodes that are left.
Edge renumbered(Edge edge, const Renumbering& nodes);
IncrementalResult renumbered(IncrementalResult result, const Renumbering& nodes);
NodeAddition renumbered(NodeAddition addition, const Renumbering& nodes);

}  // namespace oort
