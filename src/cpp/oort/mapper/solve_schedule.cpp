// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/solve_schedule.hpp"

#include <algorithm>

#include "oort/loop_closure/closure.hpp"

namespace oort {
namespace {

constexpr std::uint64_t kLeastInterval = 10;  // of progress between solves
constexpr std::uint64_t kGrowth = 20;         // the graph grows by one part in so many between solves

}  // namespace

void SolveSchedule::add_closure(double surprise) {
  ++pending_;
  surprised_ = surprised_ || surprise > kSurprise;
}

SolveSchedule::Extent SolveSchedule::due(std::uint64_t size, std::uint64_t progress) const {
  if (pending_ == 0) return Extent::kNothing;
  if (progress >= progress_at_last_ + std::max(kLeastInterval, size / kGrowth)) return Extent::kAll;
  if (!surprised_) return Extent::kNothing;
  return size > large_ ? Extent::kNewest : Extent::kAll;
}

void SolveSchedule::solved_newest() {
  pending_ = 0;
  surprised_ = false;
}

void SolveSchedule::solved_all(std::uint64_t progress) {
  solved_newest();
  progress_at_last_ = progress;
}

}  // namespace oort
