// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "brush.hpp"

#include <cmath>

#include "rounding.hpp"

namespace frsm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Where a row of cells lies on the side of `origin` that `direction` points to, border included. A half line, all or
// nothing.
Interval half_plane(const Point& origin, const Point& direction, int iy) {
  const double rest = (iy - origin.y) * direction.y;
  if (direction.x == 0.0) return rest >= 0.0 ? Interval{} : Interval{kInfinity, -kInfinity};
  const double limit = origin.x - rest / direction.x;
  return direction.x > 0.0 ? Interval{limit, kInfinity} : Interval{-kInfinity, limit};
}

// The rest of the row, border included again, so that no cell on it is lost.
Interval opposite(const Interval& half) {
  if (half.low == -kInfinity && half.high == kInfinity) return {kInfinity, -kInfinity};
  if (half.low == kInfinity) return {};
  return half.low == -kInfinity ? Interval{half.high, kInfinity} : Interval{-kInfinity, half.low};
}

}  // namespace

// All cells within the kernel's radius of the segment from a to b (in cells), by true distance: lines are equally wide
// at every slope, and lie where the points are rather than on the nearest cell. A row of cells is cut where the nearest
// part of the segment changes from one end to the line to the other end; in each part the distance is linear in x,
// squared.
void Brush::draw(const Point& a, const Point& b, bool last) {
  const Point along{b.x - a.x, b.y - a.y};
  const double length = std::hypot(along.x, along.y);
  const int first_row = ceil_to_int(std::min(a.y, b.y) - radius_);
  const int last_row = floor_to_int(std::max(a.y, b.y) + radius_);
  for (int iy = first_row; iy <= last_row; ++iy) {
    const Interval before = half_plane(a, along, iy);  // where the end b, or the line, is nearer than the end a
    const Interval after = half_plane(b, {-along.x, -along.y}, iy);
    draw_end(iy, a, length > 0.0 ? opposite(before) : Interval{});
    if (length == 0.0) continue;
    if (last) draw_end(iy, b, opposite(after));
    draw_line(iy, a, {along.x / length, along.y / length}, before.cut(after));
  }
}

void Brush::draw_end(int iy, const Point& end, const Interval& part) {
  const double ey = iy - end.y;
  const double half2 = radius_ * radius_ - ey * ey;
  if (half2 < 0.0) return;
  const double half = std::sqrt(half2);
  draw_run(iy, part.cut({end.x - half, end.x + half}), -end.x, 1.0, ey * ey);
}

void Brush::draw_line(int iy, const Point& start, const Point& direction, const Interval& part) {
  // Distance from the line: x * direction.y + offset, its sign telling the side.
  const double offset = -start.x * direction.y - (iy - start.y) * direction.x;
  Interval reach;
  if (direction.y != 0.0) {
    const double centre = -offset / direction.y;
    const double half = radius_ / std::abs(direction.y);
    reach = {centre - half, centre + half};
  } else if (std::abs(offset) > radius_) {
    return;
  }
  draw_run(iy, part.cut(reach), offset, direction.y, 0.0);
}

// Cells of a row whose squared distance from what is drawn is (offset + slope * x)^2 + rest.
void Brush::draw_run(int iy, const Interval& part, double offset, double slope, double rest) {
  if (!(part.low <= part.high)) return;
  const int x0 = ceil_to_int(part.low);
  const int x1 = floor_to_int(part.high);
  const auto root = static_cast<float>(std::sqrt(static_cast<double>(kernel_.scale)));
  const auto start = static_cast<float>((offset + slope * x0)) * root;
  const auto step = static_cast<float>(slope) * root;
  const auto base = static_cast<float>(rest * kernel_.scale) + 0.5F;
  std::uint8_t* cells = cells_ + (iy - y0_) * stride_ + (x0 - x0_);
  for (int i = 0; i <= x1 - x0; ++i) {
    const float d = start + step * static_cast<float>(i);
    cells[i] = std::max(cells[i], kernel_.values[static_cast<std::size_t>(static_cast<std::int32_t>(d * d + base))]);
  }
}

}  // namespace frsm
