// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "frsm/table.hpp"

namespace frsm {

/// A stretch of a row of cells; empty if low > high.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  Interval cut(const Interval& other) const { return {std::max(low, other.low), std::min(high, other.high)}; }
};

/// Draws segments into a rectangle of cells, each cell keeping the largest value drawn. All lengths in cells.
class Brush {
 public:
  /// The rectangle must hold all that is drawn, with the kernel's radius around it.
  Brush(const Kernel& kernel, std::uint8_t* cells, int x0, int y0, std::ptrdiff_t stride)
      : kernel_(kernel), radius_(kernel.radius), cells_(cells), x0_(x0), y0_(y0), stride_(stride) {}

  /// A segment, or a dot. Of a chain of segments only the last need draw its far end: the next begins there.
  void draw(const Point& a, const Point& b, bool last);

 private:
  void draw_end(int iy, const Point& end, const Interval& part);
  void draw_line(int iy, const Point& start, const Point& direction, const Interval& part);
  void draw_run(int iy, const Interval& part, double offset, double slope, double rest);

  const Kernel& kernel_;
  double radius_;
  std::uint8_t* cells_;
  int x0_, y0_;
  std::ptrdiff_t stride_;
};

}  // namespace frsm
