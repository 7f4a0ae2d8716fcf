// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace oort {

/// Positions along a ray are whole numbers of 1/1024 cell, so that which cells a ray crosses is decided exactly.
constexpr int kSubcellBits = 10;
constexpr std::int64_t kSubcells = std::int64_t{1} << kSubcellBits;

/// One of the 1024 x 1024 parts of a cell, counted from the grid's lower left corner; not negative. Its position is its
/// centre, which never lies on a border between cells.
struct SubcellPoint {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

/// The index (row * width + column) of the cell that holds a subcell.
inline std::size_t cell_index(const SubcellPoint& point, int width) {
  return static_cast<std::size_t>((point.y >> kSubcellBits) * width + (point.x >> kSubcellBits));
}

/// Calls visit(index) for each cell that the segment from `begin` to `end` crosses, both ends' cells included, in
/// order, each once. Where the segment goes exactly through a corner only the two cells across it are visited. After
/// Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing" (1987), in whole numbers.
template <typename Visitor>
void visit_ray(const SubcellPoint& begin, const SubcellPoint& end, int width, Visitor&& visit) {
  constexpr std::int64_t kCell = 2 * kSubcells;  // in half subcells, of which centres are odd numbers
  const std::int64_t length_x = 2 * std::llabs(end.x - begin.x);
  const std::int64_t length_y = 2 * std::llabs(end.y - begin.y);
  const std::int64_t offset_x = 2 * (begin.x % kSubcells) + 1;
  const std::int64_t offset_y = 2 * (begin.y % kSubcells) + 1;
  const bool right = end.x >= begin.x;
  const bool up = end.y >= begin.y;
  const std::int64_t stride_x = right ? 1 : -1;
  const std::int64_t stride_y = up ? width : -width;

  // The share of the ray before the next border in x is (way to it) / length_x. To compare it with the share in y
  // without dividing, both are kept multiplied by length_x * length_y. No share is 1, so none leads past the end.
  std::int64_t next_x = (right ? kCell - offset_x : offset_x) * length_y;
  std::int64_t next_y = (up ? kCell - offset_y : offset_y) * length_x;

  auto index = static_cast<std::int64_t>(cell_index(begin, width));
  const auto last = static_cast<std::int64_t>(cell_index(end, width));
  visit(static_cast<std::size_t>(index));
  while (index != last) {
    const bool cross_x = next_x <= next_y;  // arithmetic instead of branches: which way is next cannot be predicted
    const bool cross_y = next_y <= next_x;
    index += (cross_x ? stride_x : 0) + (cross_y ? stride_y : 0);
    next_x += cross_x ? kCell * length_y : 0;
    next_y += cross_y ? kCell * length_x : 0;
    visit(static_cast<std::size_t>(index));
  }
}

}  // namespace oort
