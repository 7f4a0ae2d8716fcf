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

}  // namespace

bool GridLimits::fits(const Eigen::AlignedBox2d& box, double resolution) {
  if (!(resolution > 0.0) || !std::isfinite(resolution)) {
    throw ParameterError("grid: resolution must be a positive number of metres, not " + std::to_string(resolution));
  }
  if (!box.min().allFinite() || !box.max().allFinite() || box.isEmpty()) return false;
  return cells_needed(box, resolution).prod() <= kMaxCells;
}

GridLimits GridLimits::enclosing(const Eigen::AlignedBox2d& box, double resolution) {
  if (!fits(box, resolution)) {
    throw InputError("grid: the points span more than a grid can hold (" +
                     std::to_string(static_cast<long>(kMaxCells)) +
                     " cells) or are not finite; look for a broken pose or choose a coarser resolution");
  }
  const Eigen::Array2d count = cells_needed(box, resolution);
  GridLimits limits;
  limits.resolution = resolution;
  limits.width = static_cast<int>(count.x());
  limits.height = static_cast<int>(count.y());
  limits.origin_x = box.max().x() - count.x() * resolution;
  limits.origin_y = box.max().y() - count.y() * resolution;
  return limits;
}

}  // namespace oort
