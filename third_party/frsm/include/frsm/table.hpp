// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "frsm/contours.hpp"
#include "frsm/types.hpp"

namespace frsm {

class BlockMaxima;
class BoundPyramid;

/// Is told, while a match is searched for, how many cells of tables were looked up since it was told last. Cells that
/// are read side by side, and those of bounds while they are built, count as far as they cost as much as others.
using OnLookups = std::function<void(std::uint64_t)>;

struct TableParams {
  double cell = 0.02;     ///< side of a cell [m]
  double sigma = 0.0675;  ///< the value falls to 1/e at this distance from a line [m]
  int min_value = 32;     ///< the kernel ends at the first whole cell whose value is at or below this (1..254)
  double radius = 25.0;   ///< points farther from the sensor than this are not drawn [m]

  /// Throws std::invalid_argument that names the field when a value makes no sense.
  void validate() const;
};

/// Value of a cell by its squared distance from the nearest line.
struct Kernel {
  explicit Kernel(const TableParams& params);

  int radius;                        ///< where it ends [cells]
  int scale;                         ///< entries per squared cell
  std::vector<std::uint8_t> values;  ///< values[round(scale * d^2)]
};

/// The rectangle of cells a table holds, for code that reads many of them. Cell (ix, iy) of the lattice is
/// data[(iy - y0) * stride + (ix - x0)]; cells outside the rectangle are 0.
struct TableView {
  const std::uint8_t* data = nullptr;
  int x0 = 0, y0 = 0;         ///< lattice index of the first cell
  int width = 0, height = 0;  ///< [cells]
  std::ptrdiff_t stride = 0;  ///< [bytes] from row to row
};

/// Likelihood of seeing a range point, per cell: 255 exp(-d / sigma), d the distance to the nearest drawn line.
/// Cells lie on one global lattice, cell i centred at i * cell, so coordinates never move as the table grows.
/// Drawing takes the maximum of old and new: idempotent and independent of order. Reading is thread-safe while nobody
/// draws.
class Table {
 public:
  explicit Table(const TableParams& params = {});

  /// Draws a scan: lines between the consecutive points of each contour, dots for single points.
  /// `world`: all points of the scan in the table's frame; `origin`: where they were seen from.
  /// Points that are not finite or farther than params().radius from the origin are left out, and lines to them.
  /// Throws std::length_error when the drawn area would exceed 2^28 cells; the table is then unchanged.
  void draw(const Points& world, const std::vector<Contour>& contours, const Pose& origin);

  /// Makes room for points in an area [m], so that nothing is copied while they are drawn.
  /// Throws std::length_error when it would exceed 2^28 cells; the table is then unchanged.
  void reserve(const Point& low, const Point& high);

  /// Value of a cell of the lattice, 0 outside.
  std::uint8_t value(int ix, int iy) const;

  /// Index of the cell that a coordinate [m] lies in (nearest centre). |coordinate| / cell must be below 2^30.
  int index(double coordinate) const;
  /// Centre of a cell. [m]
  double coordinate(int index) const { return index * params_.cell; }

  /// Smooth value, 0..1, at any point [m], with its gradient per metre: quadratic B-spline over 3 x 3 cells, which is
  /// continuous in value and slope, and whose peak lies on the line whatever the line's place between cell centres.
  double interpolate(double x, double y, double* dx, double* dy) const;

  void clear();
  bool empty() const { return empty_; }
  /// Memory of the cells, bounds included. [bytes]
  std::size_t bytes() const;
  const TableParams& params() const { return params_; }
  TableView view() const;

  /// Upper bounds for branch and bound, built at the first call after a change. Thread-safe.
  std::shared_ptr<const BoundPyramid> bounds(const OnLookups& on_lookups = {}) const;
  /// Coarser ones that are built in a tenth of the time, likewise.
  std::shared_ptr<const BlockMaxima> blocks(const OnLookups& on_lookups = {}) const;

 private:
  void cover(int low_x, int low_y, int high_x, int high_y);

  TableParams params_;
  double inverse_cell_;
  Kernel kernel_;
  std::vector<std::uint8_t> cells_;
  int x0_ = 0, y0_ = 0, width_ = 0, height_ = 0;
  bool empty_ = true;
  mutable std::shared_ptr<const BoundPyramid> bounds_;
  mutable std::shared_ptr<const BlockMaxima> blocks_;
};

}  // namespace frsm
