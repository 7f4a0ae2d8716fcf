// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/grid/grid_limits.hpp"

namespace oort {

/// A beam on the map [m].
struct Beam {
  Eigen::Vector2d from;
  Eigen::Vector2d end;  ///< the return, or how far nothing was found
  bool is_return = false;
};

/// A node's beams, one for each point of its cloud; none for one that says nothing. `reach` [m]: how far a beam without
/// return found nothing.
std::vector<std::optional<Beam>> beams_of(const PointCloud& cloud, const Pose2& T_map_sensor, double reach);

/// How many nodes saw something in each cell, and how many saw through it, from which side.
class EvidenceGrid {
 public:
  static constexpr unsigned kSides = 8;  ///< of 45 degrees

  explicit EvidenceGrid(const GridLimits& limits);

  /// Counts a node's beams. Those that leave the grid count for nothing.
  void add(const std::vector<std::optional<Beam>>& beams);

  /// The cell of a point, if it is on the grid.
  std::optional<std::size_t> cell(const Eigen::Vector2d& point) const;
  /// The cells on the beam's way, up to shortly before its end; none if it leaves the grid.
  std::vector<std::size_t> way_of(const Beam& beam) const;

  /// Nodes that saw something in the cell or next to it.
  unsigned hits_around(std::size_t cell) const;
  unsigned hits(std::size_t cell) const { return hits_[cell]; }
  /// Nodes that saw through the cell about along the beam.
  unsigned misses_along(std::size_t cell, const Beam& beam) const;
  unsigned misses(std::size_t cell) const;

 private:
  GridLimits limits_;
  std::vector<std::uint16_t> hits_;
  std::vector<std::uint8_t> misses_;  // by cell and side
  std::vector<std::uint32_t> hit_by_, missed_by_;
  std::uint32_t node_ = 0;
};

}  // namespace oort
