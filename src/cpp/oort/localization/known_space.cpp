// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/localization/known_space.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "oort/grid/range_data.hpp"
#include "oort/localization/tuning.hpp"
#include "oort/loop_closure/normal_consistency.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

OutputGridParameters grid_parameters() {
  OutputGridParameters p{};
  p.resolution = LocalizationTuning::kCell;
  p.hit_probability = LocalizationTuning::kHitProbability;
  p.miss_probability = LocalizationTuning::kMissProbability;
  p.insert_free_space = true;
  p.clear_infs = false;
  p.inf_clear_dist = 0.0;
  return p;
}

GridLimits limits_of(const Map& map, const std::vector<std::uint64_t>& nodes) {
  Eigen::AlignedBox2d box(Eigen::Vector2d::Zero());
  const OutputGridParameters parameters = grid_parameters();
  for (const std::uint64_t node : nodes) {
    const Pose2& pose = map.graph.nodes[node].pose;
    box.extend(pose.translation());
    for (const BeamEnd& end : beam_ends(map.clouds[node], pose, parameters)) box.extend(end.point);
  }
  const double coarsest = std::sqrt(box.volume() / LocalizationTuning::kMaxCells);
  const double resolution = std::clamp(coarsest, parameters.resolution, LocalizationTuning::kLargestCell);
  const Eigen::Vector2d border = Eigen::Vector2d::Constant(2.0 * resolution);
  return GridLimits::enclosing({box.min() - border, box.max() + border}, resolution);
}

int sector_of(const Eigen::Vector2d& normal) {
  const double turns = std::atan2(normal.y(), normal.x()) / (2.0 * M_PI);
  return static_cast<int>(std::lround(LocalizationTuning::kNormalSectors * (turns + 1.0))) %
         LocalizationTuning::kNormalSectors;
}

// The sectors within an eighth of a turn of one.
std::uint8_t around(int sector) {
  unsigned bits = 0;
  for (const int step : {LocalizationTuning::kNormalSectors - 1, 0, 1}) {
    bits |= 1U << ((sector + step) % LocalizationTuning::kNormalSectors);
  }
  return static_cast<std::uint8_t>(bits);
}

}  // namespace

KnownSpace::KnownSpace(const Map& map, const std::vector<std::uint64_t>& nodes)
    : grid_(limits_of(map, nodes)), facing_(grid_.limits().cell_count(), 0) {
  const RangeDataInserter inserter(grid_parameters());
  for (const std::uint64_t node : nodes) {
    inserter.insert(map.clouds[node], map.graph.nodes[node].pose, grid_);
    add_surfaces(map.clouds[node], map.graph.nodes[node].pose);
  }
}

void KnownSpace::add_surfaces(const PointCloud& cloud, const Pose2& T_map_sensor) {
  const Eigen::Matrix2d R = rotation(T_map_sensor.theta);
  for (const SurfacePoint& surface : surface_points(returns_of(cloud))) {
    const Eigen::Vector2i cell = cell_of(T_map_sensor * surface.position);
    if (cell.x() < 0) continue;
    std::uint8_t& seen = facing_[limits().index(cell.x(), cell.y())];
    seen = static_cast<std::uint8_t>(seen | (1U << sector_of(R * surface.normal)));
  }
}

Eigen::Vector2i KnownSpace::cell_of(const Eigen::Vector2d& p_map) const {
  const Eigen::Vector2d cell = limits().to_cells(p_map);
  const bool inside = cell.minCoeff() >= 0.0 && cell.x() < limits().width && cell.y() < limits().height;
  return inside ? Eigen::Vector2i(cell.cast<int>()) : Eigen::Vector2i(-1, -1);
}

double KnownSpace::probability(const Eigen::Vector2d& p_map) const {
  const Eigen::Vector2i cell = cell_of(p_map);
  return grid_.is_known(cell.x(), cell.y()) ? grid_.probability(cell.x(), cell.y()) : 0.5;
}

bool KnownSpace::is_wall(const Eigen::Vector2d& p_map) const {
  return probability(p_map) > LocalizationTuning::kWall;
}

bool KnownSpace::is_free(const Eigen::Vector2d& p_map) const {
  return probability(p_map) < LocalizationTuning::kFree;
}

/// Nothing is known beyond the grid's border: the walk ends there, however far the point is.
bool KnownSpace::is_blocked(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double margin) const {
  const Eigen::Vector2d way = to - from;
  const double length = way.norm();
  if (!std::isfinite(length)) return false;
  const double step = limits().resolution;
  const Eigen::Vector2d low(limits().origin_x, limits().origin_y);
  const Eigen::Vector2d high = low + step * Eigen::Vector2d(limits().width, limits().height);
  const double farthest = (from.cwiseMax(high) - from.cwiseMin(low)).norm();
  const double end = std::min(length - margin, farthest + step);
  for (double at = step; at < end; at += step) {
    if (is_wall(from + way * (at / length))) return true;
  }
  return false;
}

KnownSpace::Facing KnownSpace::facing(const Eigen::Vector2d& p_map, const Eigen::Vector2d& normal) const {
  const Eigen::Vector2i cell = cell_of(p_map);
  if (cell.x() < 0) return Facing::kUnknown;
  unsigned seen = 0;
  for (int y = cell.y() - 1; y <= cell.y() + 1; ++y) {
    for (int x = cell.x() - 1; x <= cell.x() + 1; ++x) {
      if (limits().contains(x, y)) seen |= facing_[limits().index(x, y)];
    }
  }
  if ((seen & around(sector_of(normal))) != 0) return Facing::kSame;
  return (seen & around(sector_of(-normal))) != 0 ? Facing::kOther : Facing::kUnknown;
}

}  // namespace oort
