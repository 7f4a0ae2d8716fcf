// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <frsm/types.hpp>
#include <unordered_map>
#include <vector>

#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"

namespace oort {

/// A piece of a surface with its normal, towards the sensor that saw it.
struct SurfacePoint {
  Eigen::Vector2d position;
  Eigen::Vector2d normal;  ///< of length 1
};

/// The surfaces that a scan saw: its returns with the direction between their neighbours in the scan. A return whose
/// neighbours are too far off has no known direction and is left out. Points in scan order, in the sensor's frame.
std::vector<SurfacePoint> surface_points(const frsm::Points& points);

/// The normals of a submap's surfaces. A thin wall looks the same to a scan matcher from both sides; here its
/// sides differ.
class NormalMap {
 public:
  /// The surfaces seen from some nodes of one segment, in the frame of `origin`, a node of that segment.
  NormalMap(const Map& map, const TrajectorySegments& segments, std::uint64_t origin,
            const std::vector<std::uint64_t>& nodes);

  /// Of the surfaces of a scan that lie on known ones along the same line, the share that face the same way, in [0, 1];
  /// 1 if none do.
  double agreement(const std::vector<SurfacePoint>& surfaces, const Pose2& T_origin_sensor) const;

 private:
  std::unordered_map<std::uint64_t, Eigen::Vector2d> normals_;  // sums, by cell
};

}  // namespace oort
