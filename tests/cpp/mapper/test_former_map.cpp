// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/former_map.hpp"

#include <gtest/gtest.h>

#include "mapping_fixtures.hpp"

namespace oort {
namespace {

using testing::drive;
using testing::kMount;
using testing::laps;
using testing::make_room;
using testing::odometry_of;

Map map_of_one_session() {
  Mapper mapper(Parameters{}, kMount);
  const std::vector<Pose2> truth = laps(2.0);
  drive(mapper, make_room(), truth, odometry_of(truth, 0.01, 0.01));
  mapper.finish();
  return mapper.map();
}

const Map& one_session() {
  static const Map map = map_of_one_session();
  return map;
}

/// The map after another session on it.
Map gone_on_with(const Map& map) {
  Mapper mapper(Parameters{}, kMount);
  mapper.set_map(map);
  mapper.begin_session({});
  const std::vector<Pose2> truth = laps(2.0);
  drive(mapper, make_room(), truth, odometry_of(truth, 0.02, 0.02, 7));
  mapper.finish();
  return mapper.map();
}

/// As if nothing had closed the first session's loop and odometry had slipped on the way: what comes after a node lies
/// elsewhere.
Map bent(const Map& map, const Pose2& slip) {
  Map result = map;
  const std::uint64_t middle = map.graph.nodes.size() / 2;
  const Pose2 T_middle_map = inverse(map.graph.nodes[middle].pose);
  for (std::uint64_t node = middle; node < map.graph.nodes.size(); ++node) {
    result.graph.nodes[node].pose = map.graph.nodes[middle].pose * slip * T_middle_map * map.graph.nodes[node].pose;
  }
  for (Edge& edge : result.graph.edges) {
    if (edge.i < middle && edge.j >= middle) {
      edge.constraint.T_i_j = between(result.graph.nodes[edge.i].pose, result.graph.nodes[edge.j].pose);
    }
  }
  result.graph.switchable_edges.clear();
  result.loop_results.clear();
  return result;
}

double distance(const Map& map, const Map& other, std::uint64_t node) {
  return (map.graph.nodes[node].pose.translation() - other.graph.nodes[node].pose.translation()).norm();
}

TEST(FormerMap, StaysToTheBitWhereASessionFindsItAsItWas) {
  const Map after = gone_on_with(one_session());
  EXPECT_GT(after.graph.nodes.size(), one_session().graph.nodes.size());
  EXPECT_GT(after.graph.switchable_edges.size(), one_session().graph.switchable_edges.size());
  for (const Node& node : one_session().graph.nodes) {
    EXPECT_EQ(after.graph.nodes[node.id].pose.x, node.pose.x);
    EXPECT_EQ(after.graph.nodes[node.id].pose.y, node.pose.y);
    EXPECT_EQ(after.graph.nodes[node.id].pose.theta, node.pose.theta);
  }
}

TEST(FormerMap, GivesWayWhereItIsWrong) {
  const Map wrong = bent(one_session(), {0.15, 0.15, 0.0});
  const std::uint64_t last = wrong.graph.nodes.size() - 1;
  ASSERT_GT(distance(wrong, one_session(), last), 0.2);
  EXPECT_LT(distance(gone_on_with(wrong), one_session(), last), 0.05);
}

class Shape : public ::testing::Test {
 protected:
  Shape() : former_(one_session(), TrajectorySegments::of_map(one_session()), graph_.nodes.size(), {}) {
    optimize(graph_, {});
  }

  /// Moves the first nodes, so many of a hundred.
  void move(std::size_t share, const Pose2& motion) {
    for (std::size_t k = 0; 100 * k < share * graph_.nodes.size(); ++k) {
      graph_.nodes[k].pose = motion * graph_.nodes[k].pose;
    }
  }

  Graph graph_ = one_session().graph;
  FormerMap former_;
};

TEST_F(Shape, IsKeptByWhatMovesTheWholeMap) {
  EXPECT_TRUE(former_.keeps_shape(graph_));
  move(100, {1.0, -2.0, 0.5});
  EXPECT_TRUE(former_.keeps_shape(graph_));
}

TEST_F(Shape, IsKeptWhereAFewNodesMoveFarOrAllALittle) {
  move(2, {0.5, 0.0, 0.0});
  EXPECT_TRUE(former_.keeps_shape(graph_));
  move(50, {0.02, 0.0, 0.0});
  EXPECT_TRUE(former_.keeps_shape(graph_));
}

TEST_F(Shape, IsLostWhereAGoodPartOfTheMapMoves) {
  move(30, {0.15, 0.0, 0.0});
  EXPECT_FALSE(former_.keeps_shape(graph_));
}

}  // namespace
}  // namespace oort
