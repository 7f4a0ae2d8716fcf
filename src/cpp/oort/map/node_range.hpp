// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace oort {

/// Nodes that follow one another.
struct NodeRange {
  std::uint64_t begin = 0;
  std::uint64_t end =
      std::numeric_limits<std::uint64_t>::max();  ///< one past the last; none: all that are to come, too

  bool contains(std::uint64_t node) const { return begin <= node && node < end; }
};

inline bool contains(const std::vector<NodeRange>& ranges, std::uint64_t node) {
  return std::any_of(ranges.begin(), ranges.end(), [node](const NodeRange& range) { return range.contains(node); });
}

}  // namespace oort
