// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace frsm {

// Without SSE4.1, which plain x86-64 lacks, std::floor is a function call. These are for values in the range of int.

inline int floor_to_int(double value) {
  const int truncated = static_cast<int>(value);
  return truncated - (truncated > value ? 1 : 0);
}

inline int ceil_to_int(double value) {
  const int truncated = static_cast<int>(value);
  return truncated + (truncated < value ? 1 : 0);
}

}  // namespace frsm
