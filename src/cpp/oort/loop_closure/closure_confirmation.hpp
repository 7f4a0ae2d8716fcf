// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "oort/loop_closure/closure.hpp"
#include "oort/map/map.hpp"

namespace oort {

/// Holds back closures that would move much until others, found from other places, say the same: one false match is
/// easily found, several that agree with one another and with the motion between them are not (pairwise
/// consistency: Mangelson et al. 2018).
class ClosureConfirmation {
 public:
  /// Takes a closure of the newest node. Returns those that are confirmed with it, oldest first; none if it has to
  /// wait.
  std::vector<Closure> add(const Map& map, const Closure& closure);

 private:
  std::vector<Closure> waiting_;
};

}  // namespace oort
