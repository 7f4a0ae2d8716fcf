// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/render/crop.hpp"

#include <algorithm>
#include <utility>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

bool ends_outside(const Point2& point, const Pose2& T_map_sensor, const Eigen::AlignedBox2d& box) {
  return point.is_return() && !box.contains(T_map_sensor * Eigen::Vector2d(point.x, point.y));
}

}  // namespace

Cropped crop(const std::vector<Node>& nodes, const PointClouds& clouds, const Eigen::AlignedBox2d& box) {
  if (nodes.size() != clouds.size()) throw InputError("crop: each node needs a cloud of its own");
  if (box.isEmpty()) throw InputError("crop: the box must have a lower left and an upper right corner");
  Cropped cropped;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (!box.contains(nodes[k].pose.translation())) continue;
    PointCloud cloud = clouds[k];
    const auto outside = [&](const Point2& point) { return ends_outside(point, nodes[k].pose, box); };
    cloud.points.erase(std::remove_if(cloud.points.begin(), cloud.points.end(), outside), cloud.points.end());
    cropped.nodes.push_back(nodes[k]);
    cropped.clouds.push_back(std::move(cloud));
  }
  return cropped;
}

}  // namespace oort
