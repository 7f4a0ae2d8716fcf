// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "frsm/table.hpp"

namespace frsm {

/// A table in blocks of kSide x kSide cells: block (i, j) holds the largest value of the cells from (i, j) * kSide on,
/// 2 * kSide - 1 in each direction. So it bounds the value of each cell of the block, moved by 0 .. kSide - 1 cells.
class BlockMaxima {
 public:
  static constexpr int kSide = 8;

  explicit BlockMaxima(const TableView& table);

  /// As a rectangle of blocks; outside they are 0.
  TableView view() const { return {blocks_.data(), x0_, y0_, width_, height_, width_}; }
  std::size_t bytes() const { return blocks_.capacity(); }

  /// The block that a cell lies in.
  static int of(int cell) { return (cell - ((cell % kSide) + kSide) % kSide) / kSide; }

 private:
  std::vector<std::uint8_t> blocks_;
  int x0_, y0_, width_, height_;
};

}  // namespace frsm
