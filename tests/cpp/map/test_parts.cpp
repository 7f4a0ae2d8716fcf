// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Parts of a map that nothing ties, and how they are drawn.
#include <gtest/gtest.h>

#include "oort/map/parts.hpp"
#include "oort/render/render.hpp"

namespace oort {
namespace {

using Ids = std::vector<std::uint64_t>;

void link(Map& map, std::uint64_t i, std::uint64_t j, double deviation) {
  const Eigen::Matrix3d covariance = deviation * deviation * Eigen::Matrix3d::Identity();
  map.graph.edges.push_back({map.graph.edges.size(), i, j, {0.0, j, Pose2{}, covariance, ConstraintType::kLaser}});
}

/// Nodes 0 to 2, after a pause 3 to 6, each a metre on and with a wall a metre ahead.
Map paused_after_three() {
  Map map;
  for (std::uint64_t k = 0; k < 7; ++k) {
    map.graph.nodes.push_back({k, {1.0 * static_cast<double>(k), 0.0, 0.0}});
    map.clouds.push_back(PointCloud{k, 0.0, {{1.0, 0.0, 1.0}}});
    if (k > 0) link(map, k - 1, k, k == 3 ? 12.6 : 0.02);
  }
  return map;
}

SwitchableEdge closure(std::uint64_t i, std::uint64_t j, double value) {
  SwitchableEdge edge;
  edge.i = i;
  edge.j = j;
  edge.switch_value = value;
  return edge;
}

TEST(MapParts, WhatFollowsAPauseIsLooseUntilAClosureTiesIt) {
  Map map = paused_after_three();
  EXPECT_EQ(parts_of(map).main, (Ids{3, 4, 5, 6})) << "the largest";
  EXPECT_EQ(parts_of(map).loose, (std::vector<Ids>{{0, 1, 2}}));
  map.graph.switchable_edges.push_back(closure(5, 1, 0.1));
  EXPECT_EQ(parts_of(map).loose.size(), 1u) << "it is off";
  map.graph.switchable_edges.push_back(closure(5, 1, 0.9));
  EXPECT_TRUE(parts_of(map).loose.empty());
}

TEST(MapParts, TheOneWithTheDockIsTheMainOne) {
  Map map = paused_after_three();
  map.locations.push_back({"dock", "dock", 1, Pose2{}});
  EXPECT_EQ(parts_of(map).main, (Ids{0, 1, 2}));
}

TEST(MapParts, AContradictionIsWideButTellsOfThePlace) {
  Map map = paused_after_three();
  map.graph.edges[2].constraint.covariance = 1.0 * Eigen::Matrix3d::Identity();
  EXPECT_TRUE(parts_of(map).loose.empty());
}

TEST(MapParts, OfNothingThereIsNone) {
  EXPECT_TRUE(parts_of(Map{}).main.empty());
  EXPECT_TRUE(parts_of(Map{}).loose.empty());
}

TEST(MapParts, LooseOnesAreNotDrawnOverTheMap) {
  Map map = paused_after_three();
  const OccupancyGrid main = render(map).map;
  EXPECT_GT(main.origin_x, 2.0) << "the nodes from 3 on alone";
  const OccupancyGrid loose = render(map, {0, 1, 2}, Parameters{}).map;
  EXPECT_LT(loose.origin_x, 1.0);
  map.graph.switchable_edges.push_back(closure(5, 1, 1.0));
  EXPECT_LT(render(map).map.origin_x, 1.0);
}

}  // namespace
}  // namespace oort
