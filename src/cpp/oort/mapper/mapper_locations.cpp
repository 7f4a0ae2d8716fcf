// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// The named places of Mapper: kept relative to nodes, so that they move with the map.
#include <algorithm>

#include "oort/geometry/errors.hpp"
#include "oort/mapper/mapper.hpp"

namespace oort {
namespace {

auto find_location(std::vector<Location>& locations, const std::string& name_space, const std::string& id) {
  return std::find_if(locations.begin(), locations.end(),
                      [&](const Location& l) { return l.name_space == name_space && l.id == id; });
}

void put(std::vector<Location>& locations, Location location) {
  const auto old = find_location(locations, location.name_space, location.id);
  if (old != locations.end()) {
    *old = std::move(location);
  } else {
    locations.push_back(std::move(location));
  }
}

}  // namespace

bool Mapper::has_pose() const {
  return last_scan_.has_value() && next_link_ == NextLink::kChain;
}

Pose2 Mapper::sensor_pose() const {
  if (!has_pose()) throw StateError("no pose of the sensor is known: no scan has been mapped yet");
  const Node& node = map_.graph.nodes.back();
  return node.pose * between(chains_.local_pose(node.id), last_scan_->tracked.T_local_sensor);
}

Pose2 Mapper::T_map_odom() const {
  return sensor_pose() * inverse(last_scan_->T_odom_base_measured * T_base_sensor_);
}

std::uint64_t Mapper::nearest_node(const Eigen::Vector2d& p_map) const {
  const auto nearest =
      std::min_element(map_.graph.nodes.begin(), map_.graph.nodes.end(), [&](const Node& a, const Node& b) {
        return (a.pose.translation() - p_map).squaredNorm() < (b.pose.translation() - p_map).squaredNorm();
      });
  if (nearest == map_.graph.nodes.end()) throw StateError("the map has no nodes yet: map something first");
  return nearest->id;
}

void Mapper::create_location(const std::string& name_space, const std::string& id, const Pose2& T_map_location) {
  if (!is_finite(T_map_location)) throw InputError("location " + name_space + "/" + id + ": the pose is not finite");
  const std::uint64_t node = nearest_node(T_map_location.translation());
  put(map_.locations, {name_space, id, node, between(map_.graph.nodes[node].pose, T_map_location)});
}

void Mapper::create_points(const std::vector<std::string>& name_spaces, const std::vector<Eigen::Vector2d>& points,
                           const std::vector<std::string>& ids) {
  if (name_spaces.size() != points.size() || ids.size() != points.size()) {
    throw InputError("create_points: give one namespace and one id per point");
  }
  if (points.empty()) return;
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) centroid += point / static_cast<double>(points.size());
  if (!centroid.allFinite()) throw InputError("create_points: a point is not finite");
  const std::uint64_t node = nearest_node(centroid);
  for (std::size_t i = 0; i < points.size(); ++i) {
    put(map_.locations,
        {name_spaces[i], ids[i], node, between(map_.graph.nodes[node].pose, Pose2{points[i].x(), points[i].y(), 0.0})});
  }
}

bool Mapper::delete_location(const std::string& name_space, const std::string& id) {
  const auto location = find_location(map_.locations, name_space, id);
  if (location == map_.locations.end()) return false;
  map_.locations.erase(location);
  return true;
}

std::optional<Pose2> Mapper::locate(const std::string& name_space, const std::string& id) const {
  for (const Location& location : map_.locations) {
    if (location.name_space == name_space && location.id == id) {
      return map_.graph.nodes[location.node_id].pose * location.T_node_location;
    }
  }
  return std::nullopt;
}

}  // namespace oort
