// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace oort {

/// A map to navigate by, with the values and the layout of nav_msgs/OccupancyGrid.
struct OccupancyGrid {
  static constexpr std::int8_t kFree = 0;
  static constexpr std::int8_t kOccupied = 100;
  static constexpr std::int8_t kUnknown = -1;

  double resolution = 0.0;         ///< side of a cell [m]
  double origin_x = 0.0;           ///< left border in the map frame [m]
  double origin_y = 0.0;           ///< lower border in the map frame [m]
  int width = 0;                   ///< columns, along x
  int height = 0;                  ///< rows, along y
  std::vector<std::int8_t> cells;  ///< row after row, row 0 (least y) first
};

}  // namespace oort
