// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/grid/range_data.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "oort/geometry/errors.hpp"
#include "oort/grid/ray.hpp"

namespace oort {
namespace {

/// The bearing [rad] of a beam without return, nothing for a beam that says nothing.
std::optional<double> bearing_without_return(const Point2& point, double inf_clear_dist) {
  if (std::isnan(point.x) || !std::isfinite(point.y)) return std::nullopt;
  if (std::isinf(point.x)) return point.x > 0.0 ? std::optional<double>(point.y) : std::nullopt;
  if (std::hypot(point.x, point.y) <= inf_clear_dist) return std::nullopt;
  return std::atan2(point.y, point.x);
}

/// Nothing if the point lies outside the grid. A point on the border, which rounding may put just outside, is inside.
std::optional<SubcellPoint> to_subcells(const Eigen::Vector2d& point, const GridLimits& limits) {
  constexpr double kTolerance = 1e-6;  // cells
  const Eigen::Vector2d cells = limits.to_cells(point);
  if (!(cells.minCoeff() >= -kTolerance && cells.x() <= limits.width + kTolerance &&
        cells.y() <= limits.height + kTolerance)) {
    return std::nullopt;
  }
  const auto clamp = [](double value, int count) {
    const auto subcell = static_cast<std::int64_t>(std::floor(value * static_cast<double>(kSubcells)));
    return std::clamp<std::int64_t>(subcell, 0, count * kSubcells - 1);
  };
  return SubcellPoint{clamp(cells.x(), limits.width), clamp(cells.y(), limits.height)};
}

}  // namespace

std::vector<BeamEnd> beam_ends(const PointCloud& cloud, const Pose2& T_map_sensor,
                               const OutputGridParameters& parameters) {
  const Eigen::Matrix2d R = rotation(T_map_sensor.theta);
  const Eigen::Vector2d t = T_map_sensor.translation();
  const bool clears = parameters.insert_free_space && parameters.clear_infs;
  std::vector<BeamEnd> ends;
  ends.reserve(cloud.points.size());
  for (const Point2& point : cloud.points) {
    if (point.is_return()) {
      if (std::isfinite(point.x) && std::isfinite(point.y)) {
        ends.push_back({R * Eigen::Vector2d(point.x, point.y) + t, true});
      }
    } else if (clears) {
      if (const auto bearing = bearing_without_return(point, parameters.inf_clear_dist)) {
        const Eigen::Vector2d ray(std::cos(*bearing), std::sin(*bearing));
        ends.push_back({R * (parameters.inf_clear_dist * ray) + t, false});
      }
    }
  }
  return ends;
}

BeamInserter::BeamInserter(const ProbabilityGridParameters& parameters)
    : insert_free_space_(parameters.insert_free_space),
      hit_table_(parameters.hit_probability),
      miss_table_(parameters.miss_probability) {}

bool BeamInserter::insert(const Eigen::Vector2d& sensor, const std::vector<BeamEnd>& ends,
                          ProbabilityGrid& grid) const {
  const GridLimits& limits = grid.limits();
  const std::optional<SubcellPoint> begin = to_subcells(sensor, limits);
  if (!begin) return false;
  std::vector<SubcellPoint> cells;
  cells.reserve(ends.size());
  for (const BeamEnd& end : ends) {
    const std::optional<SubcellPoint> cell = to_subcells(end.point, limits);
    if (!cell) return false;
    cells.push_back(*cell);
  }
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (ends[i].is_hit) grid.update(cell_index(cells[i], limits.width), hit_table_);
  }
  if (insert_free_space_) {
    for (const SubcellPoint& end : cells) {
      visit_ray(*begin, end, limits.width, [&](std::size_t index) { grid.update(index, miss_table_); });
    }
  }
  grid.finish_update();
  return true;
}

void BeamInserter::insert_growing(const Eigen::Vector2d& sensor, const std::vector<BeamEnd>& ends,
                                  ProbabilityGrid& grid) const {
  Eigen::AlignedBox2d box(sensor);
  for (const BeamEnd& end : ends) box.extend(end.point);
  grid.grow(box);
  insert(sensor, ends, grid);
}

RangeDataInserter::RangeDataInserter(const OutputGridParameters& parameters)
    : parameters_(parameters), inserter_(parameters) {
  if (!(parameters.inf_clear_dist >= 0.0) || !std::isfinite(parameters.inf_clear_dist)) {
    throw ParameterError("probability_grid: inf_clear_dist must be a distance in metres, not " +
                         std::to_string(parameters.inf_clear_dist));
  }
}

void RangeDataInserter::insert(const PointCloud& cloud, const Pose2& T_map_sensor, ProbabilityGrid& grid) const {
  if (!inserter_.insert(T_map_sensor.translation(), beam_ends(cloud, T_map_sensor, parameters_), grid)) {
    throw InputError("probability grid: the cloud of node " + std::to_string(cloud.id) +
                     " reaches outside the grid; make the grid's limits from the same clouds and poses");
  }
}

}  // namespace oort
