// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stdexcept>
#include <string>

namespace frsm {

/// Throws std::invalid_argument("frsm: <what> <problem>") unless the condition holds.
inline void check(bool condition, const char* what, const char* problem) {
  if (!condition) throw std::invalid_argument(std::string("frsm: ") + what + " " + problem);
}

}  // namespace frsm
