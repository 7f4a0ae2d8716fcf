// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/render/speckle.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

void require(bool holds, const char* rule) {
  if (!holds) throw ParameterError(std::string("output_map: ") + rule);
}

/// A number for each cell, row by row.
struct Layer {
  Layer(int width, int height, int value = 0)
      : width(width), height(height), cells(static_cast<std::size_t>(width) * height, value) {}

  int width, height;
  std::vector<int> cells;
};

/// 1 in the cells of one state, 0 elsewhere.
Layer layer_of(const OccupancyGrid& map, std::int8_t state) {
  Layer layer(map.width, map.height);
  std::transform(map.cells.begin(), map.cells.end(), layer.cells.begin(),
                 [state](std::int8_t cell) { return cell == state ? 1 : 0; });
  return layer;
}

/// For each row the sums of it and of those up to `reach` above and below, of which there are none outside.
Layer row_sums(const Layer& layer, int reach) {
  Layer sums(layer.width, layer.height);
  std::vector<int> sum(layer.width, 0);
  const auto add = [&](int y, int sign) {
    const int* row = &layer.cells[static_cast<std::size_t>(y) * layer.width];
    for (int x = 0; x < layer.width; ++x) sum[x] += sign * row[x];
  };
  for (int y = 0; y < std::min(reach, layer.height); ++y) add(y, 1);
  for (int y = 0; y < layer.height; ++y) {
    if (reach < layer.height - y) add(y + reach, 1);
    std::copy(sum.begin(), sum.end(), sums.cells.begin() + static_cast<std::ptrdiff_t>(y) * layer.width);
    if (y >= reach) add(y - reach, -1);
  }
  return sums;
}

/// For each cell the sum over the square around it, which reaches `reach` cells to each side.
Layer box_sums(const Layer& layer, int reach) {
  Layer sums = row_sums(layer, reach);
  std::vector<int> row(layer.width);
  for (int y = 0; y < layer.height; ++y) {
    int* const line = &sums.cells[static_cast<std::size_t>(y) * layer.width];
    std::copy_n(line, layer.width, row.begin());
    int sum = std::accumulate(row.begin(), row.begin() + std::min(reach, layer.width), 0);
    for (int x = 0; x < layer.width; ++x) {
      if (reach < layer.width - x) sum += row[x + reach];
      line[x] = sum;
      if (x >= reach) sum -= row[x - reach];
    }
  }
  return sums;
}

/// The set cells that are 8-connected to `seed`; takes them off the layer.
std::vector<std::size_t> take_group(Layer& layer, std::size_t seed) {
  std::vector<std::size_t> group{seed};
  layer.cells[seed] = 0;
  for (std::size_t next = 0; next < group.size(); ++next) {
    const int x = static_cast<int>(group[next] % layer.width), y = static_cast<int>(group[next] / layer.width);
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, layer.height - 1); ++v) {
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, layer.width - 1); ++u) {
        const std::size_t cell = static_cast<std::size_t>(v) * layer.width + u;
        if (layer.cells[cell] == 0) continue;
        layer.cells[cell] = 0;
        group.push_back(cell);
      }
    }
  }
  return group;
}

/// Occupied cells in 8-connected groups of at least `least` cells.
std::vector<std::size_t> walls_of(const OccupancyGrid& map, int least) {
  Layer occupied = layer_of(map, OccupancyGrid::kOccupied);
  std::vector<std::size_t> walls;
  for (std::size_t seed = 0; seed < occupied.cells.size(); ++seed) {
    if (occupied.cells[seed] == 0) continue;
    const std::vector<std::size_t> group = take_group(occupied, seed);
    if (group.size() >= static_cast<std::size_t>(least)) walls.insert(walls.end(), group.begin(), group.end());
  }
  return walls;
}

void median(OccupancyGrid& map, const MedianParameters& parameters) {
  // Of two values the median is the one that occurs more often: the sign of a sum. Occupied cells add nothing to it.
  Layer votes(map.width, map.height);
  std::transform(map.cells.begin(), map.cells.end(), votes.cells.begin(), [](std::int8_t cell) {
    if (cell == OccupancyGrid::kOccupied) return 0;
    return cell == OccupancyGrid::kFree ? 1 : -1;
  });
  const std::vector<std::size_t> walls = walls_of(map, parameters.kernel_size);
  for (int i = 0; i < parameters.iter; ++i) {
    const Layer sums = box_sums(votes, parameters.kernel_size / 2);
    for (std::size_t cell = 0; cell < sums.cells.size(); ++cell) {
      if (sums.cells[cell] != 0) votes.cells[cell] = sums.cells[cell] > 0 ? 1 : -1;
    }
    for (const std::size_t cell : walls) votes.cells[cell] = 0;
  }
  std::transform(votes.cells.begin(), votes.cells.end(), map.cells.begin(), [](int vote) {
    if (vote == 0) return OccupancyGrid::kOccupied;
    return vote > 0 ? OccupancyGrid::kFree : OccupancyGrid::kUnknown;
  });
}

/// Closes a layer. What lies outside the map counts as not set, or walls near its border would grow to it.
Layer closed(const Layer& layer, int iterations) {
  if (iterations == 0) return layer;
  Layer padded(layer.width + 2 * iterations, layer.height + 2 * iterations);
  for (int y = 0; y < layer.height; ++y) {
    std::copy_n(&layer.cells[static_cast<std::size_t>(y) * layer.width], layer.width,
                &padded.cells[static_cast<std::size_t>(y + iterations) * padded.width + iterations]);
  }
  // Dilating n times by a 3x3 square is dilating once by one of 2n + 1 cells, and so with eroding.
  Layer dilated = box_sums(padded, iterations);
  for (int& cell : dilated.cells) cell = cell > 0 ? 1 : 0;
  const Layer around = box_sums(dilated, iterations);
  const int full = (2 * iterations + 1) * (2 * iterations + 1);
  Layer result(layer.width, layer.height);
  for (int y = 0; y < layer.height; ++y) {
    for (int x = 0; x < layer.width; ++x) {
      const std::size_t cell = static_cast<std::size_t>(y + iterations) * padded.width + x + iterations;
      result.cells[static_cast<std::size_t>(y) * layer.width + x] = around.cells[cell] == full ? 1 : 0;
    }
  }
  return result;
}

void morphological(OccupancyGrid& map, const MorphologicalParameters& parameters) {
  const Layer free = closed(layer_of(map, OccupancyGrid::kFree), parameters.free_space_morpho_iterations);
  const Layer occupied = closed(layer_of(map, OccupancyGrid::kOccupied), parameters.occupied_morpho_iterations);
  std::transform(free.cells.begin(), free.cells.end(), occupied.cells.begin(), map.cells.begin(),
                 [](int is_free, int is_occupied) {
                   if (is_occupied != 0) return OccupancyGrid::kOccupied;
                   return is_free != 0 ? OccupancyGrid::kFree : OccupancyGrid::kUnknown;
                 });
}

}  // namespace

OccupancyGrid remove_speckles(const OccupancyGrid& map, const OutputMapParameters& parameters) {
  const MedianParameters& m = parameters.median;
  const MorphologicalParameters& morph = parameters.morphological;
  require(m.kernel_size > 0 && m.kernel_size % 2 == 1, "median.kernel_size must be odd");
  require(m.iter >= 0 && morph.free_space_morpho_iterations >= 0 && morph.occupied_morpho_iterations >= 0,
          "a number of iterations must not be negative");
  require(parameters.speckle_strategy == "median" || parameters.speckle_strategy == "morphological",
          "speckle_strategy must be \"median\" or \"morphological\"");
  OccupancyGrid cleaned = map;
  if (map.cells.empty()) return cleaned;
  if (parameters.speckle_strategy == "median") {
    median(cleaned, m);
  } else {
    morphological(cleaned, morph);
  }
  return cleaned;
}

}  // namespace oort
