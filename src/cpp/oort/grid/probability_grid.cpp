// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/grid/probability_grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

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

void ProbabilityGrid::grow(const Eigen::AlignedBox2d& box) {
  const GridLimits grown = limits_.grown(box);
  if (grown.width == limits_.width && grown.height == limits_.height) return;
  std::vector<std::uint16_t> cells(grown.cell_count(), kUnknown);
  const auto left = static_cast<int>(std::lround((limits_.origin_x - grown.origin_x) / limits_.resolution));
  const auto below = static_cast<int>(std::lround((limits_.origin_y - grown.origin_y) / limits_.resolution));
  for (int row = 0; row < limits_.height; ++row) {
    const auto begin = cells_.begin() + static_cast<std::ptrdiff_t>(limits_.index(0, row));
    std::copy(begin, begin + limits_.width,
              cells.begin() + static_cast<std::ptrdiff_t>(grown.index(left, row + below)));
  }
  cells_ = std::move(cells);
  limits_ = grown;
}

void ProbabilityGrid::finish_update() {
  for (const std::size_t index : updated_) cells_[index] = static_cast<std::uint16_t>(cells_[index] & ~kUpdated);
  updated_.clear();
}

double ProbabilityGrid::value_to_probability(double value) {
  return kMinProbability + (value - 1.0) * kStep;
}

std::uint16_t ProbabilityGrid::probability_to_value(double probability) {
  const double clamped = std::clamp(probability, kMinProbability, kMaxProbability);
  return static_cast<std::uint16_t>(std::lround((clamped - kMinProbability) / kStep) + 1);
}

}  // namespace oort
