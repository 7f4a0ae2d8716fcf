// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "slice.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace frsm {
namespace {

constexpr int kVector = 16;          // columns added at once: one SSE2 or NEON register of bytes
constexpr std::size_t kBatch = 256;  // 256 * 255 still fits 16 bits

// Adds, for one row of 16 neighbouring shifts, the bytes under up to 256 points.
void add_batch(const std::uint8_t* table, const std::int32_t* offsets, std::size_t count, std::uint32_t* sums) {
  std::array<std::uint16_t, kVector> batch{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* row = table + offsets[i];
    for (int c = 0; c < kVector; ++c) batch[c] = static_cast<std::uint16_t>(batch[c] + row[c]);
  }
  for (int c = 0; c < kVector; ++c) sums[c] += batch[c];
}

}  // namespace

void to_cells(const Table& table, const Points& body, const Pose& pose, std::vector<Cell>* cells) {
  const double c = std::cos(pose.theta);
  const double s = std::sin(pose.theta);
  cells->clear();
  for (const Point& p : body) {
    cells->push_back({table.index(pose.x + c * p.x - s * p.y), table.index(pose.y + s * p.x + c * p.y)});
  }
}

std::uint32_t sum_values(const TableView& view, const std::vector<Cell>& cells, int ix, int iy) {
  const int shift_x = ix - view.x0;
  const int shift_y = iy - view.y0;
  const auto width = static_cast<unsigned>(view.width);
  const auto height = static_cast<unsigned>(view.height);
  std::uint32_t sum = 0;
  for (const Cell& cell : cells) {
    const auto column = static_cast<unsigned>(cell.x + shift_x);  // below zero wraps to beyond the width
    const auto row = static_cast<unsigned>(cell.y + shift_y);
    if (column < width && row < height) sum += view.data[row * view.stride + column];
  }
  return sum;
}

Slice::Slice(int nx, int ny)
    : nx_(nx),
      ny_(ny),
      stride_((2 * nx + kVector) / kVector * kVector),
      sums_(static_cast<std::size_t>(stride_) * (2 * ny + 1)) {}

void Slice::score(const TableView& table, const std::vector<Cell>& cells) {
  std::fill(sums_.begin(), sums_.end(), 0U);
  offsets_.clear();
  for (const Cell& cell : cells) {
    const int column = cell.x - nx_ - table.x0;  // of the window's low corner
    const int row = cell.y - ny_ - table.y0;
    if (column >= 0 && row >= 0 && column + stride_ <= table.width && row + 2 * ny_ < table.height) {
      offsets_.push_back(static_cast<std::int32_t>(row * table.stride + column));
    } else {
      add_clipped(table, cell);
    }
  }
  add_inner(table);
}

void Slice::add_inner(const TableView& table) {
  for (std::size_t first = 0; first < offsets_.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, offsets_.size() - first);
    for (int row = 0; row <= 2 * ny_; ++row) {
      for (int column = 0; column < stride_; column += kVector) {
        add_batch(table.data + row * table.stride + column, &offsets_[first], count,
                  &sums_[static_cast<std::size_t>(row) * stride_ + column]);
      }
    }
  }
}

void Slice::add_clipped(const TableView& table, const Cell& cell) {
  const int first_x = std::max(-nx_, table.x0 - cell.x);
  const int last_x = std::min(nx_, table.x0 + table.width - 1 - cell.x);
  const int first_y = std::max(-ny_, table.y0 - cell.y);
  const int last_y = std::min(ny_, table.y0 + table.height - 1 - cell.y);
  for (int iy = first_y; iy <= last_y; ++iy) {
    const std::uint8_t* values = table.data + (cell.y + iy - table.y0) * table.stride + (cell.x - table.x0);
    std::uint32_t* sums = &sums_[static_cast<std::size_t>(iy + ny_) * stride_ + nx_];
    for (int ix = first_x; ix <= last_x; ++ix) sums[ix] += values[ix];
  }
}

}  // namespace frsm
