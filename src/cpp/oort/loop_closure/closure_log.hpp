// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>

#include "oort/geometry/pose2.hpp"
#include "oort/map/renumbering.hpp"
#include "oort/matching/rejection.hpp"

namespace oort {

/// One attempt to close a loop.
struct ClosureAttempt {
  std::uint64_t query = 0;
  std::uint64_t candidate = 0;
  Rejection rejection = Rejection::kNone;
  Pose2 T_candidate_query;    ///< where the match put the query; where the graph expected it, if there is no match
  double inlier_ratio = 0.0;  ///< of the match that was looked at last
};

/// Remembers the latest attempts to close loops, for people who tune. It holds none unless it is given room.
class ClosureLog {
 public:
  /// How many attempts are kept: the newest. Those that are too many now are forgotten.
  void set_capacity(std::size_t capacity);

  void add(ClosureAttempt attempt);

  /// An attempt that was rejected when it was added is accepted after all.
  void accept(std::uint64_t query, std::uint64_t candidate);

  /// The map was reduced: attempts of nodes that went are their carriers' now.
  void renumber(const Renumbering& nodes);

  const std::deque<ClosureAttempt>& attempts() const { return attempts_; }
  std::uint64_t forgotten() const { return forgotten_; }  ///< for want of room

 private:
  void trim();

  std::size_t capacity_ = 0;
  std::uint64_t forgotten_ = 0;
  std::deque<ClosureAttempt> attempts_;  // oldest first
};

}  // namespace oort
