// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/grid/grid_limits.hpp"

namespace oort {

/// What an observation of probability p does to every value a cell can have: odds <- odds * p / (1 - p).
class OddsTable {
 public:
  /// `probability` in (0, 1): above 0.5 for a hit, below for a miss. Throws ParameterError otherwise.
  explicit OddsTable(double probability);

  std::uint16_t operator[](std::uint16_t value) const { return values_[value]; }

 private:
  std::vector<std::uint16_t> values_;
};

/// Occupancy probabilities of the cells of a grid, as odds clamped to [0.1, 0.9] (Hess et al. 2016, section IV-B).
/// A cell that no observation touched is unknown, which differs from a probability of 0.5. Cells are 15-bit numbers,
/// so that an observation is one table look-up.
class ProbabilityGrid {
 public:
  static constexpr double kMinProbability = 0.1;
  static constexpr double kMaxProbability = 0.9;
  static constexpr std::uint16_t kUnknown = 0;
  static constexpr std::uint16_t kMaxValue = 32767;

  /// Every cell unknown.
  explicit ProbabilityGrid(const GridLimits& limits) : limits_(limits), cells_(limits.cell_count(), kUnknown) {}

  /// Makes the grid wider, with unknown cells, until it holds the box and some cells around. What cells there are stay
  /// where they are. Not between update() and finish_update(). Throws InputError, with the grid unchanged, if the box
  /// is not finite or the grid would have more than GridLimits::kMaxCells.
  void grow(const Eigen::AlignedBox2d& box);

  const GridLimits& limits() const { return limits_; }

  /// The values of all cells, row 0 (least y) first: kUnknown, or 1...kMaxValue for kMinProbability...kMaxProbability.
  /// Valid between updates only.
  const std::vector<std::uint16_t>& values() const { return cells_; }

  bool is_known(int column, int row) const {
    return limits_.contains(column, row) && cells_[limits_.index(column, row)] != kUnknown;
  }

  /// kMinProbability where the cell is unknown or outside the grid.
  double probability(int column, int row) const {
    return is_known(column, row) ? value_to_probability(cells_[limits_.index(column, row)]) : kMinProbability;
  }

  /// Applies an observation to a cell, unless the cell got one since the last finish_update(). The first one ever sets
  /// the cell to the observation's probability.
  void update(std::size_t index, const OddsTable& table) {
    std::uint16_t& cell = cells_[index];
    if ((cell & kUpdated) != 0) return;
    cell = static_cast<std::uint16_t>(table[cell] | kUpdated);
    updated_.push_back(index);
  }

  /// Ends the observations of one cloud: each cell may be updated again.
  void finish_update();

  /// Linear, so that it turns a mean of values into the mean of their probabilities; not for kUnknown.
  static double value_to_probability(double value);
  static std::uint16_t probability_to_value(double probability);

 private:
  static constexpr std::uint16_t kUpdated = 0x8000;

  GridLimits limits_;
  std::vector<std::uint16_t> cells_;
  std::vector<std::size_t> updated_;
};

}  // namespace oort
