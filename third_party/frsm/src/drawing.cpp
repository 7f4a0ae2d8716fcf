// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "frsm/table.hpp"

namespace frsm {

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
  cover({static_cast<int>(std::floor(low_x)) - radius_cells_, static_cast<int>(std::floor(low_y)) - radius_cells_,
         static_cast<int>(std::ceil(high_x)) + radius_cells_, static_cast<int>(std::ceil(high_y)) + radius_cells_});
  std::atomic_store(&bounds_, std::shared_ptr<const BoundPyramid>());
  empty_ = false;
  for (const Contour& contour : contours) {
    for (std::size_t k = 0; k < contour.size(); ++k) {
      const bool linked = k > 0 && kept[contour[k - 1]];
      const bool continues = k + 1 < contour.size() && kept[contour[k + 1]];
      if (!kept[contour[k]] || (!linked && continues)) continue;  // drawn with the line that starts here
      draw_segment(scaled[contour[linked ? k - 1 : k]], scaled[contour[k]]);
    }
  }
}

// All cells within the kernel's radius of the segment from a to b (in cells), by true distance: lines are equally wide at
// every slope, and lie where the points are rather than on the nearest cell.
void Table::draw_segment(const Point& a, const Point& b) {
  const double radius = radius_cells_;
  const Point& low = a.y <= b.y ? a : b;
  const Point& high = a.y <= b.y ? b : a;
  const double slope = high.y > low.y ? (high.x - low.x) / (high.y - low.y) : 0.0;
  const int first_row = static_cast<int>(std::ceil(low.y - radius));
  const int last_row = static_cast<int>(std::floor(high.y + radius));
  for (int iy = first_row; iy <= last_row; ++iy) {
    double x0 = low.x;  // the part of the segment that can reach this row
    double x1 = high.x;
    if (high.y > low.y) {
      x0 = low.x + slope * (std::clamp(iy - radius, low.y, high.y) - low.y);
      x1 = low.x + slope * (std::clamp(iy + radius, low.y, high.y) - low.y);
    }
    draw_row(iy, std::min(x0, x1) - radius, std::max(x0, x1) + radius, a, b);
  }
}

void Table::draw_row(int iy, double first, double last, const Point& a, const Point& b) {
  const auto dx = static_cast<float>(b.x - a.x);
  const auto dy = static_cast<float>(b.y - a.y);
  const float length2 = dx * dx + dy * dy;
  const float inverse = length2 > 0.0F ? 1.0F / length2 : 0.0F;
  const auto vy = static_cast<float>(iy - a.y);
  const auto scale = static_cast<float>(kernel_scale_);
  const int x0 = static_cast<int>(std::ceil(first));
  const int count = static_cast<int>(std::floor(last)) - x0 + 1;
  std::uint8_t* cell = cells_.data() + static_cast<std::ptrdiff_t>(iy - y0_) * width_ + (x0 - x0_);
  const auto start = static_cast<float>(x0 - a.x);
  const auto limit = static_cast<float>(kernel_.size());
  for (int i = 0; i < count; ++i) {
    const float vx = start + static_cast<float>(i);
    const float t = std::min(1.0F, std::max(0.0F, (vx * dx + vy * dy) * inverse));
    const float ex = vx - t * dx;
    const float ey = vy - t * dy;
    const float entry = (ex * ex + ey * ey) * scale + 0.5F;
    if (entry < limit) cell[i] = std::max(cell[i], kernel_[static_cast<std::size_t>(entry)]);
  }
}

}  // namespace frsm
