// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/evidence_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "oort/grid/ray.hpp"
#include "oort/maintenance/lifelong_tuning.hpp"

namespace oort {
namespace {

unsigned side_of(const Beam& beam) {
  const Eigen::Vector2d way = beam.end - beam.from;
  const double share = (std::atan2(way.y(), way.x()) + M_PI) / (2.0 * M_PI);
  return static_cast<unsigned>(std::floor(share * EvidenceGrid::kSides)) % EvidenceGrid::kSides;
}

SubcellPoint subcell(const Eigen::Vector2d& cells) {
  return {static_cast<std::int64_t>(std::floor(cells.x() * static_cast<double>(kSubcells))),
          static_cast<std::int64_t>(std::floor(cells.y() * static_cast<double>(kSubcells)))};
}

}  // namespace

std::vector<std::optional<Beam>> beams_of(const PointCloud& cloud, const Pose2& T_map_sensor, double reach) {
  std::vector<std::optional<Beam>> beams;
  beams.reserve(cloud.points.size());
  const Eigen::Vector2d from = T_map_sensor.translation();
  for (const Point2& point : cloud.points) {
    if (point.is_return()) {
      beams.push_back(Beam{from, T_map_sensor * Eigen::Vector2d(point.x, point.y), true});
    } else if (std::isinf(point.x) && point.x > 0.0) {
      beams.push_back(Beam{from, T_map_sensor * Eigen::Vector2d(reach * std::cos(point.y), reach * std::sin(point.y))});
    } else {
      beams.emplace_back();
    }
  }
  return beams;
}

EvidenceGrid::EvidenceGrid(const GridLimits& limits)
    : limits_(limits),
      hits_(limits.cell_count()),
      misses_(limits.cell_count() * kSides),
      hit_by_(limits.cell_count()),
      missed_by_(limits.cell_count()) {}

void EvidenceGrid::add(const std::vector<std::optional<Beam>>& beams) {
  ++node_;
  for (const std::optional<Beam>& beam : beams) {
    if (!beam || !beam->is_return) continue;
    const std::optional<std::size_t> end = cell(beam->end);
    if (!end || hit_by_[*end] == node_) continue;
    hit_by_[*end] = node_;
    ++hits_[*end];
  }
  for (const std::optional<Beam>& beam : beams) {
    if (!beam) continue;
    const unsigned side = side_of(*beam);
    for (const std::size_t crossed : way_of(*beam)) {
      if (missed_by_[crossed] == node_ || hit_by_[crossed] == node_) continue;
      missed_by_[crossed] = node_;
      std::uint8_t& count = misses_[crossed * kSides + side];
      if (count < std::numeric_limits<std::uint8_t>::max()) ++count;
    }
  }
}

std::optional<std::size_t> EvidenceGrid::cell(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d cells = limits_.to_cells(point).array().floor();
  if (!(cells.minCoeff() >= 0.0 && cells.x() < limits_.width && cells.y() < limits_.height)) return std::nullopt;
  return limits_.index(static_cast<int>(cells.x()), static_cast<int>(cells.y()));
}

std::vector<std::size_t> EvidenceGrid::way_of(const Beam& beam) const {
  const Eigen::Vector2d way = beam.end - beam.from;
  const double length = way.norm() - LifelongTuning::kShy;
  if (!(length > 0.0)) return {};
  const Eigen::Vector2d end = beam.from + length / way.norm() * way;
  if (!cell(beam.from) || !cell(end)) return {};
  std::vector<std::size_t> crossed;
  visit_ray(subcell(limits_.to_cells(beam.from)), subcell(limits_.to_cells(end)), limits_.width,
            [&](std::size_t index) { crossed.push_back(index); });
  return crossed;
}

unsigned EvidenceGrid::hits_around(std::size_t cell) const {
  const int column = static_cast<int>(cell % static_cast<std::size_t>(limits_.width));
  const int row = static_cast<int>(cell / static_cast<std::size_t>(limits_.width));
  unsigned hits = 0;
  for (int y = row - 1; y <= row + 1; ++y) {
    for (int x = column - 1; x <= column + 1; ++x) {
      if (limits_.contains(x, y)) hits += hits_[limits_.index(x, y)];
    }
  }
  return hits;
}

unsigned EvidenceGrid::misses_along(std::size_t cell, const Beam& beam) const {
  const unsigned side = side_of(beam);
  unsigned misses = 0;
  for (const unsigned turn : {kSides - 1, 0u, 1u}) misses += misses_[cell * kSides + (side + turn) % kSides];
  return misses;
}

unsigned EvidenceGrid::misses(std::size_t cell) const {
  unsigned misses = 0;
  for (unsigned side = 0; side < kSides; ++side) misses += misses_[cell * kSides + side];
  return misses;
}

}  // namespace oort
