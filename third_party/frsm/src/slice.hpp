// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "frsm/table.hpp"
#include "frsm/types.hpp"

namespace frsm {

/// A cell of the table's lattice.
struct Cell {
  int x, y;
};

/// The cells of a scan's points under a pose; rounded once, so that shifts of the pose by whole cells shift the cells.
void to_cells(const Table& table, const Points& body, const Pose& pose, std::vector<Cell>* cells);

/// Sum of the table's values under a scan that is shifted by whole cells.
std::uint32_t sum_values(const TableView& table, const std::vector<Cell>& cells, int ix, int iy);

/// Sums of the table's values under a scan, for all shifts by -nx .. nx and -ny .. ny cells.
class Slice {
 public:
  Slice(int nx, int ny);

  void score(const TableView& table, const std::vector<Cell>& cells);
  std::uint32_t sum(int ix, int iy) const { return sums_[static_cast<std::size_t>(iy + ny_) * stride_ + ix + nx_]; }

 private:
  void add_inner(const TableView& table);
  void add_clipped(const TableView& table, const Cell& cell);

  int nx_, ny_;
  int stride_;  // columns, rounded up to whole vectors
  std::vector<std::uint32_t> sums_;
  std::vector<std::int32_t> offsets_;
};

}  // namespace frsm
