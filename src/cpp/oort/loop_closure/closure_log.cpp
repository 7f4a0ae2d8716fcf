// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/closure_log.hpp"

#include <algorithm>
#include <utility>

namespace oort {

void ClosureLog::set_capacity(std::size_t capacity) {
  capacity_ = capacity;
  trim();
}

void ClosureLog::add(ClosureAttempt attempt) {
  if (capacity_ == 0) return;
  attempts_.push_back(attempt);
  trim();
}

void ClosureLog::accept(std::uint64_t query, std::uint64_t candidate) {
  const auto found = std::find_if(attempts_.rbegin(), attempts_.rend(), [=](const ClosureAttempt& attempt) {
    return attempt.query == query && attempt.candidate == candidate;
  });
  if (found != attempts_.rend()) found->rejection = Rejection::kNone;
}

void ClosureLog::renumber(const Renumbering& nodes) {
  const auto T_carrier = [&](std::uint64_t node) {
    return node < nodes.carrier.size() ? nodes.T_carrier_node[node] : Pose2{};
  };
  for (ClosureAttempt& attempt : attempts_) {
    attempt.T_candidate_query =
        T_carrier(attempt.candidate) * attempt.T_candidate_query * inverse(T_carrier(attempt.query));
    attempt.query = nodes.of(attempt.query);
    attempt.candidate = nodes.of(attempt.candidate);
  }
}

void ClosureLog::trim() {
  while (attempts_.size() > capacity_) {
    attempts_.pop_front();
    ++forgotten_;
  }
}

}  // namespace oort
