// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

namespace oort {

/// Where a grid of square cells lies in the map frame. Cell (column, row) covers
/// [origin_x + column * resolution, origin_x + (column + 1) * resolution) in x, likewise in y; row 0 is at the bottom
/// (least y). A cell's index is row * width + column.
struct GridLimits {
  double resolution = 0.05;  ///< side of a cell [m]
  double origin_x = 0.0;     ///< left border [m]
  double origin_y = 0.0;     ///< lower border [m]
  int width = 0;             ///< columns
  int height = 0;            ///< rows

  /// The largest grid that is made: 2^26 cells, which is 410 m x 410 m at 5 cm. More comes from a broken pose.
  static constexpr double kMaxCells = 67108864.0;

  /// The limits whose upper right corner is the box's, with as many whole cells as the box needs (at least one).
  /// Throws InputError if fits() is false.
  static GridLimits enclosing(const Eigen::AlignedBox2d& box, double resolution);

  /// Whether the box is finite, not empty, and needs at most kMaxCells cells. Throws ParameterError for a
  /// resolution that is not positive.
  static bool fits(const Eigen::AlignedBox2d& box, double resolution);

  /// These limits, or wider ones on the same lattice that hold the box too. Every side that must move goes farther than
  /// it must, by an eighth of the width, so that growing step by step costs little. Throws InputError if the box is not
  /// finite or the limits would hold more than kMaxCells.
  GridLimits grown(const Eigen::AlignedBox2d& box) const;

  std::size_t cell_count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

  bool contains(int column, int row) const { return column >= 0 && column < width && row >= 0 && row < height; }

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }

  /// A point of the map frame [m] in units of cells from the lower left corner.
  Eigen::Vector2d to_cells(const Eigen::Vector2d& point) const {
    return {(point.x() - origin_x) / resolution, (point.y() - origin_y) / resolution};
  }
};

}  // namespace oort
