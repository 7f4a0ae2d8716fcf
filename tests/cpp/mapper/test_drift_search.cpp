// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Loops that are open farther than they are searched for are closed (docs/loops.md).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "mapping_fixtures.hpp"
#include "oort/mapper/drift_search.hpp"
#include "oort/mapper/look_queue.hpp"

namespace oort {
namespace {

using namespace testing;

/// A lap of a room, 25 m away over ground where nothing is seen, back, and another lap. At the far end the graph is
/// `turned` [rad] wrong, and knows that it may be by `sigma`.
class DriftSearchTest : public ::testing::Test {
 protected:
  void drive(const World& world_of_return, double turned, double sigma) {
    const std::vector<Pose2> lap = thinned(laps(1.0), 5);
    for (const Pose2& place : lap) add(make_room(), place, Pose2{}, 0.005);
    for (int k = 1; k <= 25; ++k) add({}, lap.back() * Pose2{1.0 * k, 0.0, 0.0}, Pose2{}, 0.005);
    const Pose2 far = truth_.back();
    const Pose2 drift = far * Pose2{0.0, 0.0, turned} * inverse(far);
    for (int k = 24; k >= 0; --k) add({}, lap.back() * Pose2{1.0 * k, 0.0, 0.0}, drift, k == 24 ? sigma : 0.005);
    for (const Pose2& place : lap) add(world_of_return, place, drift, 0.005);
  }

  bool looks_while_driving_ = true;
  std::vector<Closure> closures_;
  std::vector<Pose2> truth_;
  Map map_;
  TrajectorySegments segments_;
  DriftSearch search_{Parameters(), LoopClosureBuilder(Parameters()).search()};

 private:
  static std::vector<Pose2> thinned(const std::vector<Pose2>& way, std::size_t step) {
    std::vector<Pose2> kept;
    for (std::size_t k = 0; k < way.size(); k += step) kept.push_back(way[k]);
    return kept;
  }

  void add(const World& world, const Pose2& place, const Pose2& T_map_world, double sigma_theta) {
    const std::uint64_t id = map_.graph.nodes.size();
    PointCloud cloud = to_point_cloud(see(world, place, static_cast<double>(id), kAllRound));
    cloud.id = id;
    map_.clouds.push_back(std::move(cloud));
    map_.graph.nodes.push_back({id, T_map_world * place});
    segments_.add(id == 0, true, place);
    truth_.push_back(place);
    if (id > 0) {
      Edge edge;
      edge.i = id - 1;
      edge.j = id;
      edge.constraint.T_i_j = between(map_.graph.nodes[id - 1].pose, map_.graph.nodes[id].pose);
      edge.constraint.covariance = Eigen::Vector3d(1e-4, 1e-4, sigma_theta * sigma_theta).asDiagonal();
      map_.graph.edges.push_back(edge);
    }
    if (looks_while_driving_ && closures_.empty() && search_.is_due(segments_))
      closures_ = search_.look(map_, segments_, nullptr);
  }
};

TEST_F(DriftSearchTest, ALoopThatIsOpenByTenMetresIsClosed) {
  drive(make_room(), 0.4, 0.1);
  ASSERT_GE(closures_.size(), 3u);
  for (const Closure& closure : closures_) {
    const Pose2 off = between(between(truth_[closure.from], truth_[closure.to]), closure.T_from_to);
    EXPECT_LT(off.translation().norm(), 0.1);
    EXPECT_LT(std::abs(off.theta), 0.03);
  }
}

TEST_F(DriftSearchTest, ADriveThatEndsWhereItBeganIsClosedAtTheEnd) {
  looks_while_driving_ = false;
  drive(make_room(), 0.4, 0.1);
  EXPECT_GE(search_.look_at_end(map_, segments_, 0).size(), 3u);
}

TEST_F(DriftSearchTest, AtTheEndNothingIsLookedForOfTheMapBeforeTheSession) {
  looks_while_driving_ = false;
  drive(make_room(), 0.4, 0.1);
  EXPECT_TRUE(search_.look_at_end(map_, segments_, map_.graph.nodes.size() - 2).empty());
}

TEST_F(DriftSearchTest, WhatASolutionMovedLooksAgain) {
  looks_while_driving_ = false;
  drive(make_room(), 0.4, 0.1);
  std::vector<Pose2> before;
  for (const Node& node : map_.graph.nodes) before.push_back(node.pose);
  EXPECT_TRUE(nodes_to_look_again(map_, segments_, before).empty());
  const std::uint64_t moved = before.size() - 40;
  for (std::uint64_t node = moved; node < before.size(); ++node) before[node].x += 2.0;
  const std::vector<std::uint64_t> nodes = nodes_to_look_again(map_, segments_, before);
  ASSERT_FALSE(nodes.empty());
  EXPECT_GE(nodes.front(), moved);
}

TEST(LookQueue, NewNodesComeFirstThenTheNewestThatAreToLookAgain) {
  LookQueue queue;
  queue.add_again(3);
  queue.add_again(8);
  queue.add_again(3);
  queue.add(20);
  queue.add(21);
  std::vector<std::uint64_t> order;
  while (!queue.empty()) order.push_back(queue.take().node);
  EXPECT_EQ(order, (std::vector<std::uint64_t>{20, 21, 8, 3}));
}

TEST(LookQueue, OfAMapThatWasReducedNodesThatAreGoneLookNoMore) {
  Renumbering nodes = Renumbering::none(4);
  nodes.kept[1] = false;
  nodes.carrier = {0, 0, 1, 2};
  nodes.size = 3;
  LookQueue queue;
  queue.add(1);
  queue.add(2);
  queue.add_again(1);
  queue.add_again(3);
  LookQueue left = queue.renumbered(nodes);
  EXPECT_EQ(left.take().node, 1u);
  EXPECT_EQ(left.take().node, 2u);
  EXPECT_TRUE(left.empty());
}

TEST_F(DriftSearchTest, AnotherRoomIsNotTakenForIt) {
  World other;
  for (const Wall& wall : make_room()) {
    other.push_back({{0.7 * wall.a.y() + 0.3, -wall.a.x()}, {0.7 * wall.b.y() + 0.3, -wall.b.x()}});
  }
  drive(other, 0.4, 0.1);
  EXPECT_TRUE(closures_.empty());
}

TEST_F(DriftSearchTest, WhereTheGraphKnowsItsWayNothingIsLookedFor) {
  drive(make_room(), 0.4, 0.005);
  EXPECT_TRUE(closures_.empty());
}

}  // namespace
}  // namespace oort
