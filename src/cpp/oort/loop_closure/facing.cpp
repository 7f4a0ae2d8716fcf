// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/facing.hpp"

#include <cmath>

#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

constexpr double kCell = 0.1;            // [m]; a wall's two sides are farther apart or fall together when mistaken
constexpr double kMaxNeighborGap = 0.3;  // [m]; neighbours in the scan that are farther off are of something else
constexpr double kAlong = 0.7;           // cosine: surfaces that turn more (45 degrees) are not the same line

std::uint64_t cell_of(const Eigen::Vector2d& p) {
  const auto x = static_cast<std::int32_t>(std::floor(p.x() / kCell));
  const auto y = static_cast<std::int32_t>(std::floor(p.y() / kCell));
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
    if ((here - before).norm() > kMaxNeighborGap || (after - here).norm() > kMaxNeighborGap) continue;
    Eigen::Vector2d normal = Eigen::Vector2d(before.y() - after.y(), after.x() - before.x());
    if (normal.norm() < 1e-6) continue;
    normal.normalize();
    if (normal.dot(here) > 0.0) normal = -normal;  // the sensor is at the origin
    surfaces.push_back({here, normal});
  }
  return surfaces;
}

FacingMap::FacingMap(const Map& map, const Chains& chains, std::uint64_t origin,
                     const std::vector<std::uint64_t>& nodes) {
  for (const std::uint64_t node : nodes) {
    const Pose2 T_origin_node = between(chains.local_pose(origin), chains.local_pose(node));
    const Eigen::Matrix2d R = turn(T_origin_node.theta);
    for (const SurfacePoint& surface : surface_points(returns_of(map.clouds[node]))) {
      const Eigen::Vector2d p = R * surface.position + T_origin_node.translation();
      normals_.try_emplace(cell_of(p), Eigen::Vector2d::Zero()).first->second += R * surface.normal;
    }
  }
}

double FacingMap::agreement(const std::vector<SurfacePoint>& surfaces, const Pose2& T_origin_sensor) const {
  const Eigen::Matrix2d R = turn(T_origin_sensor.theta);
  int same = 0;
  int opposite = 0;
  for (const SurfacePoint& surface : surfaces) {
    const Eigen::Vector2d p = R * surface.position + T_origin_sensor.translation();
    Eigen::Vector2d known = Eigen::Vector2d::Zero();
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const auto cell = normals_.find(cell_of(p + kCell * Eigen::Vector2d(dx, dy)));
        if (cell != normals_.end()) known += cell->second;
      }
    }
    if (known.norm() < 1e-6) continue;
    const double cosine = known.normalized().dot(R * surface.normal);
    if (cosine > kAlong) ++same;
    if (cosine < -kAlong) ++opposite;
  }
  return same + opposite == 0 ? 1.0 : static_cast<double>(same) / (same + opposite);
}

}  // namespace oort
