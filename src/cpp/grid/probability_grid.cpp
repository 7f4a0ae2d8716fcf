// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/grid/probability_grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {
constexpr double kStep = (ProbabilityGrid::kMaxProbability - ProbabilityGrid::kMinProbability) /
                         static_cast<double>(ProbabilityGrid::kMaxValue - 1);
}

OddsTable::OddsTable(double probability) {
  if (!(probability > 0.0 && probability < 1.0)) {
    throw ParameterError("probability grid: a hit or miss probability must lie between 0 and 1, not be " +
                         std::to_string(probability));
  }
  const double factor = probability / (1.0 - probability);
  values_.resize(ProbabilityGrid::kMaxValue + 1);
  values_[ProbabilityGrid::kUnknown] = ProbabilityGrid::probability_to_value(probability);
  for (std::uint16_t value = 1; value <= ProbabilityGrid::kMaxValue; ++value) {
    const double before = ProbabilityGrid::value_to_probability(value);
    const double odds = factor * before / (1.0 - before);
    values_[value] = ProbabilityGrid::probability_to_value(odds / (1.0 + odds));
  }
}

void ProbabilityGrid::finish_update() {
  for (const std::size_t index : updated_) cells_[index] = static_cast<std::uint16_t>(cells_[index] & ~kUpdated);
  updated_.clear();
}

double ProbabilityGrid::value_to_probability(std::uint16_t value) {
  return kMinProbability + static_cast<double>(value - 1) * kStep;
}

std::uint16_t ProbabilityGrid::probability_to_value(double probability) {
  const double clamped = std::clamp(probability, kMinProbability, kMaxProbability);
  return static_cast<std::uint16_t>(std::lround((clamped - kMinProbability) / kStep) + 1);
}

}  // namespace oort
