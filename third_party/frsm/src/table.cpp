// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "frsm/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "check.hpp"
#include "pyramid.hpp"

namespace frsm {
namespace {

constexpr int kMargin = 32;                             // zero cells around what is drawn: windows need no clipping there
constexpr int kChunk = 64;                              // the rectangle grows in steps of this many cells
constexpr std::size_t kMaxCells = std::size_t{1} << 28;
constexpr std::size_t kKernelEntries = 8192;            // the whole kernel stays in the first-level cache

int floor_to_chunk(int i) { return i - ((i % kChunk) + kChunk) % kChunk; }

// Value at a distance from the line; both in cells.
double profile(double distance, double sigma) { return 255.0 * std::exp(-distance / sigma); }

int kernel_radius(const TableParams& params) {
  int k = 1;
  while (std::lround(profile(k, params.sigma / params.cell)) > params.min_value) ++k;
  return k;
}

}  // namespace

void TableParams::validate() const {
  check(cell >= 1e-3 && cell <= 10.0, "TableParams.cell", "must be 1 mm to 10 m");
  check(sigma > 0.0 && sigma <= 100.0 * cell, "TableParams.sigma", "must be above 0 and at most 100 cells");
  check(min_value >= 1 && min_value <= 254, "TableParams.min_value", "must be 1 to 254");
  check(radius > 0.0 && std::isfinite(radius), "TableParams.radius", "must be above 0 m and finite");
}

Table::Table(const TableParams& params) : params_(params) {
  params_.validate();
  inverse_cell_ = 1.0 / params_.cell;
  radius_cells_ = kernel_radius(params_);
  kernel_scale_ = static_cast<double>(kKernelEntries) / (radius_cells_ * radius_cells_);
  kernel_.resize(kKernelEntries + 1);
  for (std::size_t i = 0; i < kernel_.size(); ++i) {
    const double distance = std::sqrt(static_cast<double>(i) / kernel_scale_);
    kernel_[i] = static_cast<std::uint8_t>(std::lround(profile(distance, params_.sigma / params_.cell)));
  }
}

int Table::index(double coordinate) const { return static_cast<int>(std::floor(coordinate * inverse_cell_ + 0.5)); }

std::uint8_t Table::value(int ix, int iy) const {
  const int column = ix - x0_;
  const int row = iy - y0_;
  if (column < 0 || row < 0 || column >= width_ || row >= height_) return 0;
  return cells_[static_cast<std::size_t>(row) * width_ + column];
}

double Table::interpolate(double x, double y, double* dx, double* dy) const {
  const double u = x * inverse_cell_;
  const double v = y * inverse_cell_;
  const double column = std::floor(u + 0.5);
  const double row = std::floor(v + 0.5);
  *dx = *dy = 0.0;
  if (!(column > x0_ && row > y0_ && column < x0_ + width_ - 1.0 && row < y0_ + height_ - 1.0)) return 0.0;
  const double fx = u - column;  // -0.5..0.5
  const double fy = v - row;
  const double wx[3] = {0.5 * (0.5 - fx) * (0.5 - fx), 0.75 - fx * fx, 0.5 * (0.5 + fx) * (0.5 + fx)};
  const double wy[3] = {0.5 * (0.5 - fy) * (0.5 - fy), 0.75 - fy * fy, 0.5 * (0.5 + fy) * (0.5 + fy)};
  const double gx[3] = {fx - 0.5, -2.0 * fx, fx + 0.5};
  const double gy[3] = {fy - 0.5, -2.0 * fy, fy + 0.5};
  const std::uint8_t* cell = cells_.data() + static_cast<std::ptrdiff_t>(row - y0_ - 1.0) * width_ +
                             static_cast<std::ptrdiff_t>(column - x0_ - 1.0);
  double value = 0.0;
  for (int j = 0; j < 3; ++j, cell += width_) {
    const double sum = wx[0] * cell[0] + wx[1] * cell[1] + wx[2] * cell[2];
    value += wy[j] * sum;
    *dx += wy[j] * (gx[0] * cell[0] + gx[1] * cell[1] + gx[2] * cell[2]);
    *dy += gy[j] * sum;
  }
  const double scale = inverse_cell_ / 255.0;
  *dx *= scale;
  *dy *= scale;
  return value / 255.0;
}

void Table::clear() {
  cells_.clear();
  x0_ = y0_ = width_ = height_ = 0;
  empty_ = true;
  bounds_.reset();
}

std::size_t Table::bytes() const {
  const auto bounds = std::atomic_load(&bounds_);
  return cells_.capacity() + kernel_.capacity() + (bounds ? bounds->bytes() : 0);
}

TableView Table::view() const { return {cells_.data(), x0_, y0_, width_, height_, width_}; }

std::shared_ptr<const BoundPyramid> Table::bounds() const {
  auto bounds = std::atomic_load(&bounds_);
  if (!bounds) {  // two threads may both build it: they build the same
    bounds = std::make_shared<const BoundPyramid>(view());
    std::atomic_store(&bounds_, bounds);
  }
  return bounds;
}

// Grows the rectangle so that it holds a box of cells with a margin.
void Table::cover(const Box& box) {
  const bool first = width_ == 0;
  const int x0 = std::min(floor_to_chunk(box.x0 - kMargin), first ? box.x0 : x0_);
  const int y0 = std::min(floor_to_chunk(box.y0 - kMargin), first ? box.y0 : y0_);
  const int x1 = std::max(floor_to_chunk(box.x1 + kMargin) + kChunk, first ? box.x1 : x0_ + width_);
  const int y1 = std::max(floor_to_chunk(box.y1 + kMargin) + kChunk, first ? box.y1 : y0_ + height_);
  if (!first && x0 == x0_ && y0 == y0_ && x1 == x0_ + width_ && y1 == y0_ + height_) return;
  const auto width = static_cast<std::size_t>(x1 - x0);
  const auto height = static_cast<std::size_t>(y1 - y0);
  if (width * height > kMaxCells) {
    throw std::length_error("frsm: the drawn area exceeds 2^28 cells; clear the table before drawing that far away");
  }
  std::vector<std::uint8_t> cells(width * height, 0);
  for (int row = 0; row < height_; ++row) {
    std::memcpy(&cells[(row + y0_ - y0) * width + (x0_ - x0)], &cells_[static_cast<std::size_t>(row) * width_], width_);
  }
  cells_ = std::move(cells);
  x0_ = x0;
  y0_ = y0;
  width_ = static_cast<int>(width);
  height_ = static_cast<int>(height);
}

}  // namespace frsm
