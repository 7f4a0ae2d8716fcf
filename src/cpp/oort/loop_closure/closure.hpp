// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "oort/geometry/pose2.hpp"
#include "oort/graph/optimizer.hpp"
#include "oort/map/map.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// A relative pose found between two nodes that odometry did not link.
struct Closure {
  std::uint64_t from = 0;
  std::uint64_t to = 0;
  Pose2 T_from_to;
  Eigen::Matrix3d covariance;  ///< along the axes of node `from`
  double inlier_ratio = 0.0;
  double firmness = 1.0;  ///< how many times as much as usual it costs to switch it off
};

/// Makes a closure a switchable edge of the map, with its result. Returns its squared Mahalanobis distance from the
/// poses as they are, by its own covariance.
double add_closure(const Closure& closure, std::uint64_t edge_id, Map& map);

/// How the parameters want a graph to be solved.
OptimizerOptions optimizer_options(const Parameters& parameters, int max_iterations);

}  // namespace oort
