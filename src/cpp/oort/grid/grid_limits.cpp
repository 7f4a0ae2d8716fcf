// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/grid/grid_limits.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

/// Cells along each axis, as doubles because a broken box may need more than an int can count.
Eigen::Array2d cells_needed(const Eigen::AlignedBox2d& box, double resolution) {
  return (box.sizes().array() / resolution).ceil().max(1.0);
}

[[noreturn]] void too_wide() {
  throw InputError("grid: the points span more than a grid can hold (" +
                   std::to_string(static_cast<long>(GridLimits::kMaxCells)) +
                   " cells) or are not finite; look for a broken pose or choose a coarser resolution");
}

/// How many cells to add on a side that must move by `missing` cells (not at all if that is not positive).
double cells_to_add(double missing, int size) {
  const int reserve = size / 8;  // so that a grid that grows bit by bit is copied seldom
  return missing > 0.0 ? std::ceil(missing) + 1.0 + reserve : 0.0;
}

}  // namespace

bool GridLimits::fits(const Eigen::AlignedBox2d& box, double resolution) {
  if (!(resolution > 0.0) || !std::isfinite(resolution)) {
    throw ParameterError("grid: resolution must be a positive number of metres, not " + std::to_string(resolution));
  }
  if (!box.min().allFinite() || !box.max().allFinite() || box.isEmpty()) return false;
  return cells_needed(box, resolution).prod() <= kMaxCells;
}

GridLimits GridLimits::enclosing(const Eigen::AlignedBox2d& box, double resolution) {
  if (!fits(box, resolution)) too_wide();
  const Eigen::Array2d count = cells_needed(box, resolution);
  GridLimits limits;
  limits.resolution = resolution;
  limits.width = static_cast<int>(count.x());
  limits.height = static_cast<int>(count.y());
  limits.origin_x = box.max().x() - count.x() * resolution;
  limits.origin_y = box.max().y() - count.y() * resolution;
  return limits;
}

GridLimits GridLimits::grown(const Eigen::AlignedBox2d& box) const {
  if (!box.min().allFinite() || !box.max().allFinite() || box.isEmpty()) too_wide();
  const Eigen::Vector2d low = to_cells(box.min());
  const Eigen::Vector2d high = to_cells(box.max());
  const double left = cells_to_add(-low.x(), width);
  const double below = cells_to_add(-low.y(), height);
  const double new_width = left + width + cells_to_add(high.x() - width, width);
  const double new_height = below + height + cells_to_add(high.y() - height, height);
  if (new_width * new_height > kMaxCells) too_wide();
  GridLimits limits = *this;
  limits.origin_x -= left * resolution;
  limits.origin_y -= below * resolution;
  limits.width = static_cast<int>(new_width);
  limits.height = static_cast<int>(new_height);
  return limits;
}

}  // namespace oort
