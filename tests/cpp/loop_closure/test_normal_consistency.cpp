// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/normal_consistency.hpp"

#include <gtest/gtest.h>

#include "mapping_fixtures.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

std::vector<SurfacePoint> surfaces_from(const testing::World& world, const Pose2& T_world_sensor) {
  return surface_points(returns_of(to_point_cloud(testing::see(world, T_world_sensor, 0.0))));
}

TEST(Facing, NormalsPointToTheSensor) {
  const auto surfaces = surfaces_from(testing::make_room(), {-1.5, 1.5, 0.7});
  ASSERT_GT(surfaces.size(), 100U);
  for (const SurfacePoint& surface : surfaces) {
    EXPECT_NEAR(surface.normal.norm(), 1.0, 1e-12);
    EXPECT_LT(surface.normal.dot(surface.position), 0.0);
  }
}

TEST(Facing, AWallFacesTheOtherWayFromItsOtherSide) {
  const testing::World wall = {{{-4.0, 1.0}, {4.0, 1.0}}};
  Map map;
  TrajectorySegments segments;
  testing::append_chain(wall,
                        {{-0.4, 0.0, testing::kPi / 2}, {0.0, 0.0, testing::kPi / 2}, {0.4, 0.0, testing::kPi / 2}}, {},
                        map, segments);
  const NormalMap facing(map, segments, 1, {0, 1, 2});
  const Pose2 T_world_origin{0.0, 0.0, testing::kPi / 2};
  const Pose2 same_side{0.3, 0.2, testing::kPi / 2 - 0.3};
  const Pose2 other_side{0.1, 1.8, -testing::kPi / 2 + 0.2};
  EXPECT_DOUBLE_EQ(facing.agreement(surfaces_from(wall, same_side), between(T_world_origin, same_side)), 1.0);
  EXPECT_DOUBLE_EQ(facing.agreement(surfaces_from(wall, other_side), between(T_world_origin, other_side)), 0.0);
}

TEST(Facing, WhereNothingWasSeenNothingDisagrees) {
  const testing::World wall = {{{-1.0, 1.0}, {1.0, 1.0}}};
  Map map;
  TrajectorySegments segments;
  testing::append_chain(wall, {{0.0, 0.0, testing::kPi / 2}}, {}, map, segments);
  const NormalMap facing(map, segments, 0, {0});
  EXPECT_DOUBLE_EQ(facing.agreement(surfaces_from(wall, {0.0, 0.0, testing::kPi / 2}), {50.0, 0.0, 0.0}), 1.0);
  EXPECT_DOUBLE_EQ(facing.agreement({}, {}), 1.0);
}

}  // namespace
}  // namespace oort
