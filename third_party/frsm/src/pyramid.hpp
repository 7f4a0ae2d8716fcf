// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "frsm/table.hpp"

namespace frsm {

/// Tables of sliding maxima: level h holds, at cell (ix, iy), the largest value of the 2^h x 2^h cells from there
/// upwards. A sum of such values bounds every sum over points moved by 0 .. 2^h - 1 cells (Hess et al. 2016, eq. 15).
class BoundPyramid {
 public:
  static constexpr int kLevels = 8;  // 0 is the table itself: up to shifts of 128 cells

  explicit BoundPyramid(const TableView& table);

  int top() const { return kLevels - 1; }
  /// Level 1 .. top(), as rectangles of cells; outside they are 0.
  TableView level(int h) const;
  std::size_t bytes() const;

 private:
  struct Level {
    std::vector<std::uint8_t> cells;
    int x0, y0, width, height;
  };
  std::vector<Level> levels_;
};

}  // namespace frsm
