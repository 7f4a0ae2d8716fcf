// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"

namespace oort {

/// How one scan lies on another.
struct PairMatch {
  Pose2 T_reference_scan;
  double cost = 0.0;          ///< mean of the squared distances from the reference's surfaces, each at most 0.01 [m^2]
  double inlier_ratio = 0.0;  ///< share of the points that lie within 0.1 m of a surface
  bool degenerate = true;     ///< whether a direction is left open
};

/// A scan that another is laid on by itself, without a map: iterative closest points, point to line (Censi 2008). Slow
/// beside a matcher on a grid, but it needs nothing but the two.
class ReferenceScan {
 public:
  explicit ReferenceScan(const PointCloud& cloud);

  bool is_usable() const;

  /// Lays a scan's returns, in the sensor frame, on this one from a guess.
  PairMatch align(const PointCloud& scan, const Pose2& guess) const;

 private:
  struct Surface {
    Eigen::Vector2d point;
    Eigen::Vector2d normal;
  };
  const Surface* nearest(const Eigen::Vector2d& point, double reach) const;

  std::vector<Surface> surfaces_;  // one for each return that has a neighbour on the same surface
};

}  // namespace oort
