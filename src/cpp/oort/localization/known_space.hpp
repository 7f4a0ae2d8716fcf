// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "oort/grid/grid_limits.hpp"
#include "oort/grid/probability_grid.hpp"
#include "oort/map/map.hpp"

namespace oort {

/// What a map says of the space in it: where is free floor, where are walls, and their normals.
class KnownSpace {
 public:
  /// What some nodes of a map saw. Throws InputError if it is too large for a grid.
  KnownSpace(const Map& map, const std::vector<std::uint64_t>& nodes);

  bool is_wall(const Eigen::Vector2d& p_map) const;
  bool is_free(const Eigen::Vector2d& p_map) const;

  /// Whether a beam from one point to another goes through a wall before the last `margin` [m] of its path.
  bool is_blocked(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double margin) const;

  enum class Facing { kUnknown, kSame, kOther };
  /// Whether the surfaces known within a cell of a point face as `normal` does, or only the other way.
  Facing facing(const Eigen::Vector2d& p_map, const Eigen::Vector2d& normal) const;

  /// The area that the map tells about.
  const GridLimits& limits() const { return grid_.limits(); }

 private:
  /// A cell of the grid, or -1, -1 for a point outside.
  Eigen::Vector2i cell_of(const Eigen::Vector2d& p_map) const;
  double probability(const Eigen::Vector2d& p_map) const;
  void add_surfaces(const PointCloud& cloud, const Pose2& T_map_sensor);

  ProbabilityGrid grid_;
  std::vector<std::uint8_t> facing_;  // per cell: a bit for each eighth of a turn that a surface's normal was seen in
};

}  // namespace oort
