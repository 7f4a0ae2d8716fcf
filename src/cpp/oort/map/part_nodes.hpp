// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace oort {

/// Of parts as join_parts() tells them, by each node's part: the one that has the most of the first `count` nodes; of
/// equal ones the oldest.
std::uint64_t largest_part(const std::vector<std::uint64_t>& parts, std::uint64_t count);

/// Those of the first `count` nodes that belong to a part.
std::vector<std::uint64_t> nodes_of(const std::vector<std::uint64_t>& parts, std::uint64_t part, std::uint64_t count);

}  // namespace oort
