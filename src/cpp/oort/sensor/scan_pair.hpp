// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/sensor/tuning.hpp"

namespace oort {

/// How one scan lies on another.
struct PairMatch {
  Pose2 T_reference_scan;
  double cost = 0.0;          ///< mean of the squared distances from the reference's surfaces, each at most 0.01 [m^2]
  double misfit = 0.0;        ///< the same of the points that lie on a surface alone [m^2]
  double inlier_ratio = 0.0;  ///< share of the points that lie within 0.1 m of a surface
  bool degenerate = true;     ///< whether a direction is left open
};

/// A scan that another is laid on by itself, without a map: iterative closest points, point to line (Censi 2008). Slow
/// beside a matcher on a grid, but it needs nothing but the two. Partners are looked for along the surfaces, not at
/// their returns alone: beams of 1 degree are 0.1 m apart at 6 m, and far farther along a wall that they graze.
class ReferenceScan {
 public:
  explicit ReferenceScan(const PointCloud& cloud);

  bool is_usable() const;

  /// Lays a scan's returns, in the sensor frame, on this one from a guess; of many returns only some, evenly.
  PairMatch align(const PointCloud& scan, const Pose2& guess,
                  std::size_t max_points = SensorTuning::kMaxAlignedPoints) const;

  /// The best match from some guesses, at least one: all are followed halfway, the one of least cost to the end.
  PairMatch align_best(const PointCloud& scan, const std::vector<Pose2>& guesses, std::size_t max_points) const;

 private:
  struct Surface {
    Eigen::Vector2d point;
    Eigen::Vector2d normal;
    double before, after;  // how far it reaches from the point along its line [m]: halfway to its neighbours
  };
  bool can_align(const std::vector<Eigen::Vector2d>& points) const;
  bool improve(const std::vector<Eigen::Vector2d>& points, int step, PairMatch* match) const;
  const Surface* nearest(const Eigen::Vector2d& point, double reach) const;
  void sort_by_bearing();

  std::vector<Surface> surfaces_;          // one for each return that has a neighbour on the same surface
  std::vector<std::uint32_t> by_bearing_;  // indices into them, a surface in each bin that it is seen in
  std::vector<std::uint32_t> bins_;        // where each bin begins in by_bearing_, and the end
};

}  // namespace oort
