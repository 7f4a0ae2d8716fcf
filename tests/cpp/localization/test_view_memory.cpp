// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/localization/view_memory.hpp"

#include <gtest/gtest.h>

#include "localization_fixtures.hpp"

namespace oort {
namespace {

using testing::make_room;
using testing::placed;

TEST(ViewMemory, KeepsTheLatestScansThatShowSomethingNew) {
  ViewMemory memory(0.2, 0.4, 3);
  EXPECT_TRUE(memory.add({{}, {0.0, 0.0, 0.0}}));
  EXPECT_FALSE(memory.add({{}, {0.15, 0.0, 0.3}}));
  EXPECT_TRUE(memory.add({{}, {0.15, 0.0, 0.45}}));
  EXPECT_TRUE(memory.add({{}, {0.4, 0.0, 0.45}}));
  EXPECT_TRUE(memory.add({{}, {0.7, 0.0, 0.45}}));
  EXPECT_EQ(memory.latest(5).size(), 3U);
  const std::vector<PlacedScan> two = memory.latest(2);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_DOUBLE_EQ(two.front().T_odom_sensor.x, 0.4);
  EXPECT_DOUBLE_EQ(two.back().T_odom_sensor.x, 0.7);
  memory.clear();
  EXPECT_TRUE(memory.latest(5).empty());
}

TEST(ViewMemory, AllViewsTellWhereOdometrysFrameIs) {
  const std::vector<Pose2> views = testing::views_of_room();
  const auto map = testing::reference_of(make_room(), views);
  const Pose2 T_odom_map{2.0, -1.0, 0.7};
  ViewMemory memory(0.1, 0.4, 12);
  for (std::size_t k = 0; k < 6; ++k) memory.add(placed(make_room(), views[k], T_odom_map));
  EXPECT_GT(memory.weigh(*map, inverse(T_odom_map)).value(), 0.95);
  EXPECT_LT(memory.weigh(*map, Pose2{0.3, 0.1, 0.0} * inverse(T_odom_map)).value(), 0.5);
}

}  // namespace
}  // namespace oort
