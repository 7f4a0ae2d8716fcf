// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "pyramid.hpp"

#include <algorithm>

namespace frsm {
namespace {

// The largest of two values `step` cells apart, along one axis; the rectangle grows by `step` at its low side.
void max_along_x(const TableView& in, int step, std::vector<std::uint8_t>* out) {
  const int width = in.width + step;
  out->assign(static_cast<std::size_t>(width) * in.height, 0);
  for (int row = 0; row < in.height; ++row) {
    const std::uint8_t* source = in.data + row * in.stride;
    std::uint8_t* target = out->data() + static_cast<std::ptrdiff_t>(row) * width;
    std::copy_n(source, in.width, target);  // seen from `step` cells lower
    for (int i = 0; i < in.width; ++i) target[i + step] = std::max(target[i + step], source[i]);
  }
}

void max_along_y(const std::vector<std::uint8_t>& in, int width, int height, int step, std::vector<std::uint8_t>* out) {
  const std::size_t shift = static_cast<std::size_t>(step) * width;
  const std::size_t size = static_cast<std::size_t>(width) * height;
  out->assign(size + shift, 0);
  std::copy_n(in.begin(), size, out->begin());
  for (std::size_t i = 0; i < size; ++i) (*out)[i + shift] = std::max((*out)[i + shift], in[i]);
}

}  // namespace

BoundPyramid::BoundPyramid(const TableView& table) {
  TableView below = table;
  std::vector<std::uint8_t> rows;
  for (int h = 1; h < kLevels; ++h) {
    const int step = 1 << (h - 1);
    Level level{{}, below.x0 - step, below.y0 - step, below.width + step, below.height + step};
    max_along_x(below, step, &rows);
    max_along_y(rows, level.width, below.height, step, &level.cells);
    levels_.push_back(std::move(level));
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
