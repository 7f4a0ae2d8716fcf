// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"

namespace oort {

/// A short straight piece of a surface that a scan saw.
struct SurfacePiece {
  Eigen::Vector2d center;  ///< mean of its returns [m]
  Eigen::Vector2d normal;  ///< of length 1, towards the sensor
};

/// A scan's surfaces as pieces of some 0.2 m, in beam order, in the sensor's frame. A line through several returns is
/// known better than each of them, and its direction much better than that between two neighbours. What is not
/// straight (corners, small things) or has fewer than three returns is left out.
std::vector<SurfacePiece> surface_pieces(const PointCloud& cloud);

/// The same pieces in another frame.
std::vector<SurfacePiece> transformed(const Pose2& T_a_b, const std::vector<SurfacePiece>& pieces_b);

}  // namespace oort
