// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "pyramid.hpp"

#include <algorithm>

namespace frsm {
namespace {

// The larger of `a` and `b`, cell by cell. Were the arrays not known to be different ones, nothing could be done side
// by side.
void max_of(const std::uint8_t* __restrict a, const std::uint8_t* __restrict b, std::size_t count,
            std::uint8_t* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = std::max(a[i], b[i]);
}

// Of a row, the larger of two values `step` cells apart; it grows by `step` at its low side.
void max_along_x(const std::uint8_t* row, std::size_t width, std::size_t step, std::uint8_t* out) {
  const std::size_t overlap = width > step ? width - step : 0;
  std::fill(out, out + width + step, std::uint8_t{0});
  std::copy_n(row, width, out);  // seen from `step` cells lower
  max_of(row + step, row, overlap, out + step);
  std::copy_n(row + overlap, width - overlap, out + step + overlap);
}

// The largest of four values `step` cells apart along both axes. Rows are kept until those `step` higher are there, so
// that memory is read and written once.
std::vector<std::uint8_t> max_of_four(const TableView& in, int step) {
  const auto width = static_cast<std::size_t>(in.width), wider = width + static_cast<std::size_t>(step);
  const int height = in.height + step;
  std::vector<std::uint8_t> kept(wider * static_cast<std::size_t>(step), 0);  // row y at y % step
  std::vector<std::uint8_t> row(wider, 0);
  std::vector<std::uint8_t> out(wider * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    std::uint8_t* below = &kept[wider * static_cast<std::size_t>(y % step)];
    if (y < in.height) {
      max_along_x(in.data + y * in.stride, width, static_cast<std::size_t>(step), row.data());
    } else {
      std::fill(row.begin(), row.end(), std::uint8_t{0});
    }
    max_of(row.data(), below, wider, &out[wider * static_cast<std::size_t>(y)]);
    std::copy(row.begin(), row.end(), below);
  }
  return out;
}

}  // namespace

BoundPyramid::BoundPyramid(const TableView& table) {
  TableView below = table;
  for (int h = 1; h < kLevels; ++h) {
    const int step = 1 << (h - 1);
    levels_.push_back(
        {max_of_four(below, step), below.x0 - step, below.y0 - step, below.width + step, below.height + step});
    below = this->level(h);
  }
}

TableView BoundPyramid::level(int h) const {
  const Level& level = levels_[h - 1];
  return {level.cells.data(), level.x0, level.y0, level.width, level.height, level.width};
}

std::size_t BoundPyramid::bytes() const {
  std::size_t sum = 0;
  for (const Level& level : levels_) sum += level.cells.capacity();
  return sum;
}

}  // namespace frsm
