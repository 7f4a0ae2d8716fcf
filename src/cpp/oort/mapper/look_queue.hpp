// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <set>

#include "oort/map/renumbering.hpp"

namespace oort {

/// Nodes from which loops are to be looked for: new ones in their order, then, the newest first, those that were moved
/// since they looked.
class LookQueue {
 public:
  void add(std::uint64_t node) { fresh_.push_back(node); }
  void add_again(std::uint64_t node) { again_.insert(node); }

  bool empty() const { return fresh_.empty() && again_.empty(); }
  bool has_fresh() const { return !fresh_.empty(); }

  struct Next {
    std::uint64_t node;
    bool is_fresh;
  };
  /// The next one. Not if it is empty.
  Next take() {
    const Next next = has_fresh() ? Next{fresh_.front(), true} : Next{*again_.rbegin(), false};
    if (next.is_fresh) fresh_.pop_front();
    if (!next.is_fresh) again_.erase(next.node);
    return next;
  }

  /// The same, of a map that was reduced.
  LookQueue renumbered(const Renumbering& nodes) const {
    LookQueue queue;
    for (const std::uint64_t node : fresh_) {
      if (nodes.kept[node]) queue.add(nodes.of(node));
    }
    for (const std::uint64_t node : again_) {
      if (nodes.kept[node]) queue.add_again(nodes.of(node));
    }
    return queue;
  }

 private:
  std::deque<std::uint64_t> fresh_;
  std::set<std::uint64_t> again_;
};

}  // namespace oort
