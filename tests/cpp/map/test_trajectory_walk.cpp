// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "oort/map/trajectory_walk.hpp"

namespace oort {
namespace {

/// Ten nodes 0.3 m apart on a line: a new local map begins at node 4, and another at node 7 after a pause.
class TrajectoryWalkTest : public ::testing::Test {
 protected:
  TrajectoryWalkTest() {
    for (std::uint64_t k = 0; k < 10; ++k) {
      map.graph.nodes.push_back({k, {100.0, 100.0, 1.0}});  // the solution has no say
      const Pose2 local{0.3 * static_cast<double>(k), k < 4 ? 0.0 : 5.0, 0.0};
      segments.add(k == 0 || k == 4 || k == 7, k != 2, local);
    }
    link(0, 3, 0.02);
    link(3, 4, 0.1);
    link(6, 7, 4.0);
  }

  void link(std::uint64_t i, std::uint64_t j, double deviation) {
    const Pose2 step{0.3 * static_cast<double>(j - i), 0.0, 0.0};
    const Eigen::Matrix3d covariance = deviation * deviation * Eigen::Matrix3d::Identity();
    map.graph.edges.push_back({j, i, j, {0.0, j, step, covariance, ConstraintType::kOdometry}});
  }

  Map map;
  TrajectorySegments segments;
};

TEST_F(TrajectoryWalkTest, GoesOnInANewLocalMapButNotOverAPause) {
  const std::vector<PlacedNode> nodes = walk_trajectory(map, segments, 1, Direction::kForward, 20);
  ASSERT_EQ(nodes.size(), 6u);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    EXPECT_EQ(nodes[k].node, k + 1);
    EXPECT_NEAR(nodes[k].T_origin_node.x, 0.3 * static_cast<double>(k), 1e-9);
    EXPECT_NEAR(nodes[k].T_origin_node.y, 0.0, 1e-9);
  }
  EXPECT_EQ(walk_trajectory(map, segments, 7, Direction::kForward, 20).size(), 3u);
}

TEST_F(TrajectoryWalkTest, BackwardIsTheSameWayBack) {
  const std::vector<PlacedNode> nodes = walk_trajectory(map, segments, 6, Direction::kBackward, 20);
  ASSERT_EQ(nodes.size(), 7u);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    EXPECT_EQ(nodes[k].node, 6 - k);
    EXPECT_NEAR(nodes[k].T_origin_node.x, -0.3 * static_cast<double>(k), 1e-9);
  }
  EXPECT_EQ(walk_trajectory(map, segments, 9, Direction::kBackward, 20).size(), 3u);
}

TEST_F(TrajectoryWalkTest, TakesNoMoreThanAskedFor) {
  EXPECT_EQ(walk_trajectory(map, segments, 0, Direction::kForward, 3).size(), 3u);
  EXPECT_EQ(walk_trajectory(map, segments, 0, Direction::kForward, 1).size(), 1u);
  EXPECT_EQ(walk_trajectory(map, segments, 0, Direction::kBackward, 5).size(), 1u);
}

}  // namespace
}  // namespace oort
