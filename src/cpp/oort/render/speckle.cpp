// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/render/speckle.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

constexpr std::uint8_t kSet = 255;

void require(bool holds, const char* rule) {
  if (!holds) throw ParameterError(std::string("output_map: ") + rule);
}

/// The cells of one state as an image of 0 and kSet.
cv::Mat layer_of(const OccupancyGrid& map, std::int8_t state) {
  cv::Mat layer(map.height, map.width, CV_8U);
  std::transform(map.cells.begin(), map.cells.end(), layer.begin<std::uint8_t>(),
                 [state](std::int8_t cell) { return cell == state ? kSet : std::uint8_t{0}; });
  return layer;
}

/// Occupied cells in 8-connected groups of at least `least` cells.
cv::Mat walls_of(const OccupancyGrid& map, int least) {
  cv::Mat labels, statistics, centroids;
  cv::connectedComponentsWithStats(layer_of(map, OccupancyGrid::kOccupied), labels, statistics, centroids, 8, CV_32S);
  cv::Mat walls(map.height, map.width, CV_8U);
  std::transform(labels.begin<int>(), labels.end<int>(), walls.begin<std::uint8_t>(), [&](int label) {
    const bool is_wall = label != 0 && statistics.at<int>(label, cv::CC_STAT_AREA) >= least;
    return is_wall ? kSet : std::uint8_t{0};
  });
  return walls;
}

void median(OccupancyGrid& map, const MedianParameters& parameters) {
  // Of two values the median is the one that occurs more often: the sign of a sum. Occupied cells add nothing to it.
  cv::Mat votes(map.height, map.width, CV_16S, cv::Scalar(-1));
  votes.setTo(1, layer_of(map, OccupancyGrid::kFree));
  votes.setTo(0, layer_of(map, OccupancyGrid::kOccupied));
  const cv::Mat walls = walls_of(map, parameters.kernel_size);
  for (int i = 0; i < parameters.iter; ++i) {
    cv::Mat sums;
    cv::boxFilter(votes, sums, CV_16S, {parameters.kernel_size, parameters.kernel_size}, {-1, -1}, false,
                  cv::BORDER_CONSTANT);
    votes.setTo(1, sums > 0);
    votes.setTo(-1, sums < 0);
    votes.setTo(0, walls);
  }
  std::transform(votes.begin<std::int16_t>(), votes.end<std::int16_t>(), map.cells.begin(), [](std::int16_t vote) {
    if (vote == 0) return OccupancyGrid::kOccupied;
    return vote > 0 ? OccupancyGrid::kFree : OccupancyGrid::kUnknown;
  });
}

/// Closes a layer. What lies outside the map counts as not set, or walls near its border would grow to it.
cv::Mat closed(const cv::Mat& layer, int iterations) {
  if (iterations == 0) return layer;
  cv::Mat padded, result;
  cv::copyMakeBorder(layer, padded, iterations, iterations, iterations, iterations, cv::BORDER_CONSTANT);
  cv::morphologyEx(padded, result, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}), {-1, -1},
                   iterations);
  return result(cv::Rect(iterations, iterations, layer.cols, layer.rows)).clone();
}

void morphological(OccupancyGrid& map, const MorphologicalParameters& parameters) {
  const cv::Mat free = closed(layer_of(map, OccupancyGrid::kFree), parameters.free_space_morpho_iterations);
  const cv::Mat occupied = closed(layer_of(map, OccupancyGrid::kOccupied), parameters.occupied_morpho_iterations);
  std::transform(free.begin<std::uint8_t>(), free.end<std::uint8_t>(), occupied.begin<std::uint8_t>(),
                 map.cells.begin(), [](std::uint8_t is_free, std::uint8_t is_occupied) {
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
