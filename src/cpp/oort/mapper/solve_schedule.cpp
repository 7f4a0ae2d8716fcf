// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/solve_schedule.hpp"

#include <algorithm>

#include "oort/loop_closure/closure.hpp"
#include "oort/loop_closure/tuning.hpp"
#include "oort/mapper/tuning.hpp"

namespace oort {

void SolveSchedule::add_closure(double innovation) {
  ++pending_;
  large_innovation_ = large_innovation_ || innovation > LoopClosureTuning::kLargeInnovation;
}

SolveSchedule::Extent SolveSchedule::due(std::uint64_t size, std::uint64_t progress) const {
  if (pending_ == 0) return Extent::kNothing;
  if (progress >= progress_at_last_ + std::max(MapperTuning::kMinProgress, size / MapperTuning::kGrowthParts)) {
    return Extent::kAll;
  }
  if (!large_innovation_) return Extent::kNothing;
  return size > large_ ? Extent::kNewest : Extent::kAll;
}

void SolveSchedule::solved_newest() {
  pending_ = 0;
  large_innovation_ = false;
}

void SolveSchedule::solved_all(std::uint64_t progress) {
  solved_newest();
  progress_at_last_ = progress;
}

}  // namespace oort
