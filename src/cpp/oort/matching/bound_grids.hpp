// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "oort/grid/probability_grid.hpp"

namespace oort {

/// The greatest value of the cells of each square of 2^level by 2^level cells, wherever the square lies (Hess et al.
/// 2016, section V-B). Values are a byte each: 0 to 255 for 0.1 to 0.9.
class BoundGrid {
 public:
  /// Level 0: the cells of the grid themselves.
  explicit BoundGrid(const ProbabilityGrid& grid);

  /// The next level, from the one below.
  static BoundGrid above(const BoundGrid& below, int level);

  /// Of the cells from (column, row) on, 2^level to the right and up; 0 for those outside the grid.
  std::uint8_t value(int column, int row) const {
    const auto x = static_cast<unsigned>(column + reach_);
    const auto y = static_cast<unsigned>(row + reach_);
    if (x >= static_cast<unsigned>(width_) || y >= static_cast<unsigned>(height_)) return 0;
    return values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + x];
  }

  std::size_t bytes() const { return values_.size(); }

  static double to_probability(double value) {
    return ProbabilityGrid::kMinProbability +
           value / 255.0 * (ProbabilityGrid::kMaxProbability - ProbabilityGrid::kMinProbability);
  }

 private:
  BoundGrid(int reach, int width, int height);

  int reach_;  // how far squares that still touch the grid begin to the left of it and below
  int width_;
  int height_;
  std::vector<std::uint8_t> values_;
};

/// A grid with its bounds on all levels, for branch and bound.
class BoundGrids {
 public:
  /// `depth`: number of levels, at least 1; the highest has squares of 2^(depth - 1) cells.
  BoundGrids(ProbabilityGrid grid, int depth);

  const ProbabilityGrid& grid() const { return grid_; }
  const BoundGrid& level(int level) const { return levels_[static_cast<std::size_t>(level)]; }
  int depth() const { return static_cast<int>(levels_.size()); }
  std::size_t bytes() const;

 private:
  ProbabilityGrid grid_;
  std::vector<BoundGrid> levels_;
};

}  // namespace oort
