// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/grid/voxel_filter.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/grid/tuning.hpp"

namespace oort {
namespace {

using Voxel = std::pair<double, double>;  // whole numbers, which doubles hold without overflow

}  // namespace

Points voxel_filter(const Points& points, double length) {
  if (!(length > 0.0) || !std::isfinite(length)) {
    throw ParameterError("voxel filter: the side of a voxel must be a positive number of metres, not " +
                         std::to_string(length));
  }
  std::vector<std::pair<Voxel, std::size_t>> voxels;
  voxels.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    voxels.push_back({{std::floor(points[k].x() / length), std::floor(points[k].y() / length)}, k});
  }
  std::sort(voxels.begin(), voxels.end());
  const auto same_voxel = [](const auto& a, const auto& b) { return a.first == b.first; };
  voxels.erase(std::unique(voxels.begin(), voxels.end(), same_voxel), voxels.end());
  std::sort(voxels.begin(), voxels.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  Points kept;
  kept.reserve(voxels.size());
  for (const auto& [voxel, k] : voxels) kept.push_back(points[k]);
  return kept;
}

Points adaptive_voxel_filter(const Points& points, const AdaptiveVoxelFilterParameters& parameters) {
  Points near;
  std::copy_if(points.begin(), points.end(), std::back_inserter(near),
               [&](const Eigen::Vector2d& point) { return point.norm() <= parameters.max_range; });
  const auto enough = static_cast<std::size_t>(parameters.min_num_points);
  if (near.size() <= enough || parameters.max_length == 0.0) return near;
  double too_long = parameters.max_length;
  Points kept = voxel_filter(near, too_long);
  if (kept.size() >= enough) return kept;
  double length = too_long;
  while (kept.size() < enough) {
    too_long = length;
    length /= 2.0;
    if (length < GridTuning::kMinVoxelShare * parameters.max_length) return near;
    kept = voxel_filter(near, length);
  }
  while (too_long - length > GridTuning::kVoxelPrecision * length) {
    const double middle = 0.5 * (length + too_long);
    Points fewer = voxel_filter(near, middle);
    if (fewer.size() >= enough) {
      length = middle;
      kept = std::move(fewer);
    } else {
      too_long = middle;
    }
  }
  return kept;
}

}  // namespace oort
