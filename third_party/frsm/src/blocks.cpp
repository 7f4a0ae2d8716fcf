// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "blocks.hpp"

#include <algorithm>

namespace frsm {

BlockMaxima::BlockMaxima(const TableView& table)
    : x0_(of(table.x0) - 1),
      y0_(of(table.y0) - 1),
      width_(of(table.x0 + table.width - 1) - x0_ + 1),
      height_(of(table.y0 + table.height - 1) - y0_ + 1) {
  std::vector<std::uint8_t> own(static_cast<std::size_t>(width_) * height_, 0);  // of the block's cells alone
  std::vector<std::uint8_t> columns(table.width);
  for (int block = of(table.y0); block < y0_ + height_; ++block) {
    std::fill(columns.begin(), columns.end(), std::uint8_t{0});
    const int first = std::max(block * kSide - table.y0, 0);
    const int last = std::min((block + 1) * kSide - table.y0, table.height);
    for (int row = first; row < last; ++row) {
      const std::uint8_t* values = table.data + row * table.stride;
      for (int i = 0; i < table.width; ++i) columns[i] = std::max(columns[i], values[i]);
    }
    std::uint8_t* blocks = &own[static_cast<std::size_t>(block - y0_) * width_];
    for (int i = 0; i < table.width; ++i) {
      std::uint8_t& most = blocks[of(table.x0 + i) - x0_];
      most = std::max(most, columns[i]);
    }
  }
  blocks_ = own;  // and now with the blocks beside and above it
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      std::uint8_t& most = blocks_[static_cast<std::size_t>(y) * width_ + x];
      for (int j = y; j <= std::min(y + 1, height_ - 1); ++j) {
        for (int i = x; i <= std::min(x + 1, width_ - 1); ++i) {
          most = std::max(most, own[static_cast<std::size_t>(j) * width_ + i]);
        }
      }
    }
  }
}

}  // namespace frsm
