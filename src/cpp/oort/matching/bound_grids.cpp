// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/matching/bound_grids.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

constexpr int kMostLevels = 16;

std::uint8_t to_byte(std::uint16_t value) {
  if (value == ProbabilityGrid::kUnknown) return 0;
  return static_cast<std::uint8_t>(std::lround(255.0 * (value - 1) / (ProbabilityGrid::kMaxValue - 1)));
}

}  // namespace

BoundGrid::BoundGrid(int reach, int width, int height)
    : reach_(reach),
      width_(width),
      height_(height),
      values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

BoundGrid::BoundGrid(const ProbabilityGrid& grid) : BoundGrid(0, grid.limits().width, grid.limits().height) {
  std::transform(grid.values().begin(), grid.values().end(), values_.begin(), to_byte);
}

BoundGrid BoundGrid::above(const BoundGrid& below, int level) {
  const int half = 1 << (level - 1);  // a square is four of half its side
  BoundGrid bound(below.reach_ + half, below.width_ + half, below.height_ + half);
  for (int y = 0; y < bound.height_; ++y) {
    std::uint8_t* const values = bound.values_.data() + static_cast<std::ptrdiff_t>(y) * bound.width_;
    for (const int row : {y - half, y}) {
      if (row < 0 || row >= below.height_) continue;
      const std::uint8_t* const halves = below.values_.data() + static_cast<std::ptrdiff_t>(row) * below.width_;
      for (int x = 0; x < below.width_; ++x) values[x] = std::max(values[x], halves[x]);
      for (int x = 0; x < below.width_; ++x) values[x + half] = std::max(values[x + half], halves[x]);
    }
  }
  return bound;
}

BoundGrids::BoundGrids(ProbabilityGrid grid, int depth) : grid_(std::move(grid)) {
  if (depth < 1 || depth > kMostLevels) {
    throw ParameterError("branch and bound: the depth must be from 1 to " + std::to_string(kMostLevels) + ", not " +
                         std::to_string(depth));
  }
  levels_.emplace_back(grid_);
  for (int level = 1; level < depth; ++level) levels_.push_back(BoundGrid::above(levels_.back(), level));
}

std::size_t BoundGrids::bytes() const {
  std::size_t bytes = grid_.values().size() * sizeof(std::uint16_t);
  for (const BoundGrid& level : levels_) bytes += level.bytes();
  return bytes;
}

}  // namespace oort
