// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "frsm/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "blocks.hpp"
#include "brush.hpp"
#include "check.hpp"
#include "pyramid.hpp"
#include "rounding.hpp"

namespace frsm {
namespace {

constexpr int kMargin = 32;  // zero cells around what is drawn: windows need no clipping there
constexpr int kChunk = 64;   // the rectangle grows in steps of this many cells
constexpr std::size_t kMaxCells = std::size_t{1} << 28;
// What building bounds costs, as OnLookups counts: of all levels, per cell of the table,
constexpr std::uint64_t kLookupsPerBound = 3;
// and cells whose blocks take as long as one.
constexpr std::uint64_t kCellsPerBlockLookup = 5;
constexpr int kKernelEntries = 8192;  // the whole kernel stays in the first-level cache

int floor_to_chunk(int i) {
  return i - ((i % kChunk) + kChunk) % kChunk;
}

// Value at a distance from the line; both in cells.
double profile(double distance, double sigma) {
  return 255.0 * std::exp(-distance / sigma);
}

}  // namespace

void TableParams::validate() const {
  check(cell >= 1e-3 && cell <= 10.0, "TableParams.cell", "must be 1 mm to 10 m");
  check(sigma > 0.0 && sigma <= 100.0 * cell, "TableParams.sigma", "must be above 0 and at most 100 cells");
  check(min_value >= 1 && min_value <= 254, "TableParams.min_value", "must be 1 to 254");
  check(radius > 0.0 && std::isfinite(radius), "TableParams.radius", "must be above 0 m and finite");
}

Kernel::Kernel(const TableParams& params) {
  const double sigma = params.sigma / params.cell;
  radius = 1;
  while (std::lround(profile(radius, sigma)) > params.min_value) ++radius;
  scale = std::max(1, kKernelEntries / (radius * radius));  // whole, so that whole distances in cells are exact
  const std::size_t last = static_cast<std::size_t>(scale) * radius * radius;
  values.resize(last + 2);  // one more takes what rounding pushes beyond the radius
  for (std::size_t i = 0; i <= last; ++i) {
    values[i] = static_cast<std::uint8_t>(std::lround(profile(std::sqrt(static_cast<double>(i) / scale), sigma)));
  }
}

Table::Table(const TableParams& params) : params_((params.validate(), params)), kernel_(params_) {
  inverse_cell_ = 1.0 / params_.cell;
}

void Table::draw(const Points& world, const std::vector<Contour>& contours, const Pose& origin) {
  Points scaled;  // in cells
  std::vector<bool> kept(world.size());
  double low_x = std::numeric_limits<double>::infinity(), low_y = low_x, high_x = -low_x, high_y = -low_x;
  for (std::size_t i = 0; i < world.size(); ++i) {
    const Point& p = world[i];
    scaled.push_back({p.x * inverse_cell_, p.y * inverse_cell_});
    kept[i] = std::hypot(p.x - origin.x, p.y - origin.y) <= params_.radius;  // false when not finite
    if (!kept[i]) continue;
    low_x = std::min(low_x, scaled[i].x);
    low_y = std::min(low_y, scaled[i].y);
    high_x = std::max(high_x, scaled[i].x);
    high_y = std::max(high_y, scaled[i].y);
  }
  if (!(low_x <= high_x)) return;
  cover(static_cast<int>(std::floor(low_x)) - kernel_.radius, static_cast<int>(std::floor(low_y)) - kernel_.radius,
        static_cast<int>(std::ceil(high_x)) + kernel_.radius, static_cast<int>(std::ceil(high_y)) + kernel_.radius);
  std::atomic_store(&bounds_, std::shared_ptr<const BoundPyramid>());
  std::atomic_store(&blocks_, std::shared_ptr<const BlockMaxima>());
  empty_ = false;
  Brush brush(kernel_, cells_.data(), x0_, y0_, width_);
  for (const Contour& contour : contours) {
    for (std::size_t k = 0; k < contour.size(); ++k) {
      if (!kept[contour[k]]) continue;
      const bool linked = k > 0 && kept[contour[k - 1]];
      const bool last = k + 1 == contour.size() || !kept[contour[k + 1]];
      if (linked || last) brush.draw(scaled[contour[linked ? k - 1 : k]], scaled[contour[k]], last);
    }
  }
}

void Table::reserve(const Point& low, const Point& high) {
  check(std::isfinite(low.x + low.y + high.x + high.y) && low.x <= high.x && low.y <= high.y, "the area", "is none");
  const auto cell = [this](double coordinate) { return coordinate * inverse_cell_; };
  cover(static_cast<int>(std::floor(cell(low.x))) - kernel_.radius,
        static_cast<int>(std::floor(cell(low.y))) - kernel_.radius,
        static_cast<int>(std::ceil(cell(high.x))) + kernel_.radius,
        static_cast<int>(std::ceil(cell(high.y))) + kernel_.radius);
}

int Table::index(double coordinate) const {
  return static_cast<int>(std::floor(coordinate * inverse_cell_ + 0.5));
}

std::uint8_t Table::value(int ix, int iy) const {
  const int column = ix - x0_;
  const int row = iy - y0_;
  if (column < 0 || row < 0 || column >= width_ || row >= height_) return 0;
  return cells_[static_cast<std::size_t>(row) * width_ + column];
}

double Table::interpolate(double x, double y, double* dx, double* dy) const {
  *dx = *dy = 0.0;
  const double u = x * inverse_cell_ - x0_;  // in cells of the rectangle
  const double v = y * inverse_cell_ - y0_;
  if (!(u >= 0.5 && v >= 0.5 && u < width_ - 1.5 && v < height_ - 1.5)) return 0.0;
  const int column = floor_to_int(u + 0.5);
  const int row = floor_to_int(v + 0.5);
  const double fx = u - column;  // -0.5..0.5
  const double fy = v - row;
  const double wx[3] = {0.5 * (0.5 - fx) * (0.5 - fx), 0.75 - fx * fx, 0.5 * (0.5 + fx) * (0.5 + fx)};
  const double wy[3] = {0.5 * (0.5 - fy) * (0.5 - fy), 0.75 - fy * fy, 0.5 * (0.5 + fy) * (0.5 + fy)};
  const double gx[3] = {fx - 0.5, -2.0 * fx, fx + 0.5};
  const double gy[3] = {fy - 0.5, -2.0 * fy, fy + 0.5};
  const std::uint8_t* cell = cells_.data() + static_cast<std::ptrdiff_t>(row - 1) * width_ + (column - 1);
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
  blocks_.reset();
}

std::size_t Table::bytes() const {
  const auto bounds = std::atomic_load(&bounds_);
  const auto blocks = std::atomic_load(&blocks_);
  return cells_.capacity() + kernel_.values.capacity() + (bounds ? bounds->bytes() : 0) +
         (blocks ? blocks->bytes() : 0);
}

TableView Table::view() const {
  return {cells_.data(), x0_, y0_, width_, height_, width_};
}

std::shared_ptr<const BoundPyramid> Table::bounds(const OnLookups& on_lookups) const {
  auto bounds = std::atomic_load(&bounds_);
  if (!bounds) {  // two threads may both build it: they build the same
    if (on_lookups) on_lookups(kLookupsPerBound * cells_.size());
    bounds = std::make_shared<const BoundPyramid>(view());
    std::atomic_store(&bounds_, bounds);
  }
  return bounds;
}

std::shared_ptr<const BlockMaxima> Table::blocks(const OnLookups& on_lookups) const {
  auto blocks = std::atomic_load(&blocks_);
  if (!blocks) {
    if (on_lookups) on_lookups(cells_.size() / kCellsPerBlockLookup);
    blocks = std::make_shared<const BlockMaxima>(view());
    std::atomic_store(&blocks_, blocks);
  }
  return blocks;
}

// Grows the rectangle so that it holds some cells, with a margin.
void Table::cover(int low_x, int low_y, int high_x, int high_y) {
  const bool first = width_ == 0;
  const int x0 = std::min(floor_to_chunk(low_x - kMargin), first ? low_x : x0_);
  const int y0 = std::min(floor_to_chunk(low_y - kMargin), first ? low_y : y0_);
  const int x1 = std::max(floor_to_chunk(high_x + kMargin) + kChunk, first ? high_x : x0_ + width_);
  const int y1 = std::max(floor_to_chunk(high_y + kMargin) + kChunk, first ? high_y : y0_ + height_);
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
