// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "mapping_fixtures.hpp"
#include "oort/localization/reference_map.hpp"
#include "oort/localization/relocalizer.hpp"

/// What the tests of localisation share: maps of made-up rooms, seen from true poses.
namespace oort::testing {

inline World moved(const World& world, const Pose2& T_a_world) {
  World result;
  for (const Wall& wall : world) result.push_back({T_a_world * wall.a, T_a_world * wall.b});
  return result;
}

inline World joined(World a, const World& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Sensor poses of a lap through the room of make_room(), 0.2 m apart, in the frame of the world.
inline std::vector<Pose2> views_of_room(const Pose2& T_world_room = {}) {
  std::vector<Pose2> views;
  const std::vector<Pose2> way = laps(1.0);
  for (std::size_t k = 0; k < way.size(); k += 5) views.push_back(T_world_room * way[k] * kMount);
  return views;
}

inline std::shared_ptr<const ReferenceMap> reference_of(const World& world, const std::vector<Pose2>& views) {
  Map map;
  Chains chains;
  append_chain(world, views, {}, map, chains);
  return std::make_shared<const ReferenceMap>(map, Parameters{});
}

inline PlacedScan placed(const World& world, const Pose2& T_world_sensor, const Pose2& T_odom_world = {}) {
  return {to_point_cloud(see(world, T_world_sensor, 0.0)), T_odom_world * T_world_sensor};
}

}  // namespace oort::testing
