// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/map/locations.hpp"

#include <algorithm>

#include "oort/geometry/errors.hpp"
#include "oort/map/map_check.hpp"
#include "oort/map/tuning.hpp"

namespace oort {
namespace {

auto find_location(std::vector<Location>& locations, const std::string& name_space, const std::string& id) {
  return std::find_if(locations.begin(), locations.end(),
                      [&](const Location& l) { return l.name_space == name_space && l.id == id; });
}

/// Those of map files are texts that end at a NUL.
void check_name(const std::string& name_space, const std::string& id) {
  for (const std::string& text : {name_space, id}) {
    if (text.find('\0') != std::string::npos) throw InputError("location: a name holds a NUL character");
    if (text.size() > MapTuning::kMaxNameLength) {
      throw InputError("location: a name is longer than " + std::to_string(MapTuning::kMaxNameLength) + " bytes");
    }
  }
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

std::uint64_t nearest_node(const Graph& graph, const Eigen::Vector2d& p_map) {
  const auto nearest = std::min_element(graph.nodes.begin(), graph.nodes.end(), [&](const Node& a, const Node& b) {
    return (a.pose.translation() - p_map).squaredNorm() < (b.pose.translation() - p_map).squaredNorm();
  });
  if (nearest == graph.nodes.end()) throw StateError("the map has no nodes yet: map something first");
  return nearest->id;
}

void create_location(Map& map, const std::string& name_space, const std::string& id, const Pose2& T_map_location) {
  check_name(name_space, id);
  check_reach(T_map_location, "location " + name_space + "/" + id + ": the pose");
  const std::uint64_t node = nearest_node(map.graph, T_map_location.translation());
  put(map.locations, {name_space, id, node, between(map.graph.nodes[node].pose, T_map_location)});
}

void create_points(Map& map, const std::vector<std::string>& name_spaces, const std::vector<Eigen::Vector2d>& points,
                   const std::vector<std::string>& ids) {
  if (name_spaces.size() != points.size() || ids.size() != points.size()) {
    throw InputError("create_points: give one namespace and one id per point");
  }
  if (points.empty()) return;
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) centroid += point / static_cast<double>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    check_name(name_spaces[i], ids[i]);
    check_reach({points[i].x(), points[i].y(), 0.0}, "location " + name_spaces[i] + "/" + ids[i] + ": the point");
  }
  const std::uint64_t node = nearest_node(map.graph, centroid);
  for (std::size_t i = 0; i < points.size(); ++i) {
    put(map.locations,
        {name_spaces[i], ids[i], node, between(map.graph.nodes[node].pose, Pose2{points[i].x(), points[i].y(), 0.0})});
  }
}

bool delete_location(Map& map, const std::string& name_space, const std::string& id) {
  const auto location = find_location(map.locations, name_space, id);
  if (location == map.locations.end()) return false;
  map.locations.erase(location);
  return true;
}

std::optional<Pose2> locate(const Map& map, const std::string& name_space, const std::string& id) {
  for (const Location& location : map.locations) {
    if (location.name_space == name_space && location.id == id) {
      return map.graph.nodes[location.node_id].pose * location.T_node_location;
    }
  }
  return std::nullopt;
}

}  // namespace oort
