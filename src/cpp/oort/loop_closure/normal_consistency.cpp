// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/normal_consistency.hpp"

#include <cmath>

#include "oort/geometry/tuning.hpp"
#include "oort/loop_closure/tuning.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

std::uint64_t cell_of(const Eigen::Vector2d& p) {
  const auto x = static_cast<std::int32_t>(std::floor(p.x() / LoopClosureTuning::kNormalCell));
  const auto y = static_cast<std::int32_t>(std::floor(p.y() / LoopClosureTuning::kNormalCell));
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) | static_cast<std::uint32_t>(y);
}

Eigen::Matrix2d turn(double theta) {
  return Eigen::Rotation2Dd(theta).toRotationMatrix();
}

}  // namespace

std::vector<SurfacePoint> surface_points(const frsm::Points& points) {
  std::vector<SurfacePoint> surfaces;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Eigen::Vector2d before(points[i - 1].x, points[i - 1].y);
    const Eigen::Vector2d here(points[i].x, points[i].y);
    const Eigen::Vector2d after(points[i + 1].x, points[i + 1].y);
    if ((here - before).norm() > GeometryTuning::kMaxSurfaceGap ||
        (after - here).norm() > GeometryTuning::kMaxSurfaceGap) {
      continue;
    }
    Eigen::Vector2d normal = Eigen::Vector2d(before.y() - after.y(), after.x() - before.x());
    if (normal.norm() < 1e-6) continue;
    normal.normalize();
    if (normal.dot(here) > 0.0) normal = -normal;  // the sensor is at the origin
    surfaces.push_back({here, normal});
  }
  return surfaces;
}

NormalMap::NormalMap(const Map& map, const TrajectorySegments& segments, std::uint64_t origin,
                     const std::vector<std::uint64_t>& nodes) {
  for (const std::uint64_t node : nodes) {
    const Pose2 T_origin_node = between(segments.local_pose(origin), segments.local_pose(node));
    const Eigen::Matrix2d R = turn(T_origin_node.theta);
    for (const SurfacePoint& surface : surface_points(returns_of(map.clouds[node]))) {
      const Eigen::Vector2d p = R * surface.position + T_origin_node.translation();
      normals_.try_emplace(cell_of(p), Eigen::Vector2d::Zero()).first->second += R * surface.normal;
    }
  }
}

double NormalMap::agreement(const std::vector<SurfacePoint>& surfaces, const Pose2& T_origin_sensor) const {
  const Eigen::Matrix2d R = turn(T_origin_sensor.theta);
  int same = 0;
  int opposite = 0;
  for (const SurfacePoint& surface : surfaces) {
    const Eigen::Vector2d p = R * surface.position + T_origin_sensor.translation();
    Eigen::Vector2d known = Eigen::Vector2d::Zero();
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const auto cell = normals_.find(cell_of(p + LoopClosureTuning::kNormalCell * Eigen::Vector2d(dx, dy)));
        if (cell != normals_.end()) known += cell->second;
      }
    }
    if (known.norm() < 1e-6) continue;
    const double cosine = known.normalized().dot(R * surface.normal);
    if (cosine > LoopClosureTuning::kMinCosine) ++same;
    if (cosine < -LoopClosureTuning::kMinCosine) ++opposite;
  }
  return same + opposite == 0 ? 1.0 : static_cast<double>(same) / (same + opposite);
}

}  // namespace oort
