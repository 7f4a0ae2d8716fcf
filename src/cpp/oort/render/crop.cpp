// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/render/crop.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

bool ends_outside(const Point2& point, const Pose2& T_map_sensor, const Eigen::AlignedBox2d& box) {
  return point.is_return() && !box.contains(T_map_sensor * Eigen::Vector2d(point.x, point.y));
}

}  // namespace

Cropped choose(const Map& map, const std::vector<std::uint64_t>& nodes) {
  const std::size_t count = std::min(map.graph.nodes.size(), map.clouds.size());
  Cropped chosen;
  for (const std::uint64_t node : nodes) {
    if (node >= count) {
      throw InputError("render: there is no node " + std::to_string(node) + " to draw; the map's are 0 to " +
                       std::to_string(count) + ", the last left out");
    }
    chosen.nodes.push_back(map.graph.nodes[node]);
    chosen.clouds.push_back(map.clouds.shared(node));
  }
  return chosen;
}

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
