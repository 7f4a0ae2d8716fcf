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

void ClosureLog::trim() {
  while (attempts_.size() > capacity_) {
    attempts_.pop_front();
    ++forgotten_;
  }
}

}  // namespace oort
