// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/map/part_nodes.hpp"

#include <algorithm>

namespace oort {

std::uint64_t largest_part(const std::vector<std::uint64_t>& parts, std::uint64_t count) {
  std::vector<std::uint64_t> sizes(parts.size(), 0);
  for (std::uint64_t node = 0; node < count; ++node) ++sizes[parts[node]];
  return static_cast<std::uint64_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
}

std::vector<std::uint64_t> nodes_of(const std::vector<std::uint64_t>& parts, std::uint64_t part, std::uint64_t count) {
  std::vector<std::uint64_t> nodes;
  for (std::uint64_t node = 0; node < count; ++node) {
    if (parts[node] == part) nodes.push_back(node);
  }
  return nodes;
}

}  // namespace oort
