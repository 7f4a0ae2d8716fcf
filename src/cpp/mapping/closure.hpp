// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "oort/geometry/pose2.hpp"

namespace oort {

/// A relative pose found between two nodes that odometry did not link.
struct Closure {
  std::uint64_t from = 0;
  std::uint64_t to = 0;
  Pose2 T_from_to;
  Eigen::Matrix3d covariance;  ///< along the axes of node `from`
  double hit_fraction = 0.0;
  double firmness = 1.0;  ///< how many times as much as usual it costs to switch it off
};

}  // namespace oort
