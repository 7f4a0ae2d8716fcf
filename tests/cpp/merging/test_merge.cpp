// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/merging/merge.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "localization_fixtures.hpp"
#include "oort/geometry/errors.hpp"
#include "oort/map/map_check.hpp"

namespace oort {
namespace {

using testing::joined;
using testing::kMount;
using testing::laps;
using testing::make_room;
using testing::moved;
using testing::odometry_of;
using testing::World;

/// The map of a drive through a world, with the drive's first pose as its origin.
Map map_of(const World& world, const std::vector<Pose2>& way, double start, std::uint64_t seed) {
  Mapper mapper(Parameters{}, kMount);
  testing::drive(mapper, world, way, odometry_of(way, 0.02, 0.01, seed), start);
  mapper.finish();
  return mapper.map();
}

/// Laps the other way round, from the other side of the room.
std::vector<Pose2> way_back() {
  const std::vector<Pose2> forth = laps(1.0);
  std::vector<Pose2> back;
  for (std::size_t k = 0; k < forth.size(); ++k) {
    const Pose2& pose = forth[(forth.size() + forth.size() / 2 - k) % forth.size()];
    back.push_back(pose * Pose2{0.0, 0.0, testing::kPi});
  }
  return back;
}

std::vector<Pose2> moved(std::vector<Pose2> way, const Pose2& T_a_way) {
  for (Pose2& pose : way) pose = T_a_way * pose;
  return way;
}

/// How far the nodes are from where the drives truly made them, at worst: nodes are known by their clouds' times.
double worst_error(const Map& map, const std::vector<Pose2>& way_a, const std::vector<Pose2>& way_b) {
  double worst = 0.0;
  for (const Node& node : map.graph.nodes) {
    const double time = map.clouds[node.id].time;
    const bool is_b = time >= 1000.0;
    const std::vector<Pose2>& way = is_b ? way_b : way_a;
    const auto scan = static_cast<std::size_t>(std::lround((time - (is_b ? 1000.0 : 100.0)) / 0.1));
    const Pose2 truth = between(way_a[0] * kMount, way[scan] * kMount);
    worst = std::max(worst, (truth.translation() - node.pose.translation()).norm());
  }
  return worst;
}

class MergeTest : public ::testing::Test {
 protected:
  const std::vector<Pose2> forth = laps(1.0);
  const std::vector<Pose2> back = way_back();
  const Map a = map_of(make_room(), forth, 100.0, 1);
  const Map b = map_of(make_room(), back, 1000.0, 2);
};

std::string refusal(const Map& a, const Map& b, const std::optional<Pose2>& at = std::nullopt) {
  try {
    merge_maps(a, b, Parameters{}, at);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST_F(MergeTest, TwoDrivesOfARoomBecomeOneMap) {
  const Merged merged = merge_maps(a, b, Parameters{});
  EXPECT_EQ(merged.placement.found_by, "search");
  EXPECT_EQ(merged.first_node_b, a.graph.nodes.size());
  EXPECT_EQ(merged.map.graph.nodes.size(), a.graph.nodes.size() + b.graph.nodes.size());
  EXPECT_FALSE(find_defect(merged.map));
  EXPECT_GE(merged.across_kept, 10u);
  EXPECT_LE(merged.across_kept, merged.across.accepted);
  EXPECT_LT(worst_error(a, forth, back), 0.05);
  EXPECT_LT(worst_error(merged.map, forth, back), 0.05);
  const Pose2 truth = between(forth[0] * kMount, back[0] * kMount);
  EXPECT_LT(between(truth, merged.placement.T_a_b).translation().norm(), 0.1);
  EXPECT_EQ(merged.map.graph.nodes[0].pose.x, a.graph.nodes[0].pose.x);
}

TEST_F(MergeTest, TheOtherWayRoundIsTheSameMapInTheOtherFrame) {
  const Map first = merge_maps(a, b, Parameters{}).map;
  const Map second = merge_maps(b, a, Parameters{}).map;
  const std::size_t n = a.graph.nodes.size();
  const Pose2 T_first_second = between(second.graph.nodes[b.graph.nodes.size()].pose, first.graph.nodes[0].pose);
  const Pose2 b_in_first = first.graph.nodes[n].pose;
  EXPECT_LT((b_in_first.translation() - (T_first_second * second.graph.nodes[0].pose).translation()).norm(), 0.05);
}

TEST_F(MergeTest, IsDeterministicAndChangesNeitherMap) {
  const Map before = a;
  const Map first = merge_maps(a, b, Parameters{}).map;
  const Map second = merge_maps(a, b, Parameters{}).map;
  ASSERT_EQ(first.graph.switchable_edges.size(), second.graph.switchable_edges.size());
  for (std::size_t k = 0; k < first.graph.nodes.size(); ++k) {
    EXPECT_EQ(first.graph.nodes[k].pose.x, second.graph.nodes[k].pose.x);
    EXPECT_EQ(first.graph.nodes[k].pose.theta, second.graph.nodes[k].pose.theta);
  }
  for (std::size_t k = 0; k < a.graph.nodes.size(); ++k)
    EXPECT_EQ(a.graph.nodes[k].pose.x, before.graph.nodes[k].pose.x);
  EXPECT_EQ(a.graph.edges.size(), before.graph.edges.size());
}

TEST_F(MergeTest, AGivenPlaceMayBeOff) {
  const Pose2 truth = between(forth[0] * kMount, back[0] * kMount);
  const Merged merged = merge_maps(a, b, Parameters{}, truth * Pose2{0.3, -0.2, 0.1});
  EXPECT_EQ(merged.placement.found_by, "given");
  EXPECT_LT(worst_error(merged.map, forth, back), 0.05);
  EXPECT_NE(refusal(a, b, truth * Pose2{1.5, 1.0, 0.8}).find("at the place that was given"), std::string::npos);
  for (const Pose2& nowhere : {Pose2{NAN, 0.0, 0.0}, Pose2{1e7, 0.0, 0.0}, Pose2{0.0, -1e300, 0.0}}) {
    EXPECT_NE(refusal(a, b, nowhere).find("100 km off; check X Y THETA"), std::string::npos) << nowhere.x;
  }
}

TEST_F(MergeTest, OfTheSamePlaceTheFirstMapsIsKept) {
  Map with_places = a;
  Map with_more = b;
  with_places.locations = {{"dock", "dock", 0, {}}, {"room", "sofa", 5, {0.1, 0.0, 0.0}}};
  const Pose2 dock_in_b = between(back[0] * kMount, forth[0] * kMount);
  const Pose2 T_node_dock = between(b.graph.nodes[3].pose, dock_in_b);
  with_more.locations = {{"dock", "charger", 3, T_node_dock},
                         {"dock", "other", 3, T_node_dock * Pose2{1.0, 0.0, 0.0}},
                         {"room", "sofa", 7, {}},
                         {"room", "table", 7, {}}};
  const Merged merged = merge_maps(with_places, with_more, Parameters{});
  EXPECT_EQ(merged.placement.found_by, "dock");
  ASSERT_EQ(merged.map.locations.size(), 4u);
  EXPECT_EQ(merged.map.locations[0].id, "dock");
  EXPECT_EQ(merged.map.locations[1].node_id, 5u);
  EXPECT_EQ(merged.map.locations[2].id, "other");
  EXPECT_EQ(merged.map.locations[3].id, "table");
  EXPECT_EQ(merged.map.locations[3].node_id, merged.first_node_b + 7);
  ASSERT_EQ(merged.dropped.size(), 2u);
  EXPECT_EQ(merged.dropped[0].id, "charger");
  EXPECT_LT(merged.dropped[0].distance, 0.1);
  EXPECT_EQ(merged.dropped[1].id, "sofa");
}

TEST_F(MergeTest, WhatCannotBeMergedIsAnError) {
  EXPECT_NE(refusal(Map{}, b).find("the first map is empty"), std::string::npos);
  EXPECT_NE(refusal(a, Map{}).find("the second map is empty"), std::string::npos);
  Map broken = b;
  broken.graph.nodes[1].pose.x = NAN;
  EXPECT_NE(refusal(a, broken).find("the second map cannot be used"), std::string::npos);
  EXPECT_NE(refusal(a, a).find("copy of the other"), std::string::npos);
}

TEST_F(MergeTest, AMapOfOneSceneIsJoinedOnlyWhereItIsSaidToLie) {
  const std::vector<Pose2> bit(back.begin(), back.begin() + 12);
  const Map scene = map_of(make_room(), bit, 1000.0, 2);
  const std::string told = refusal(a, scene);
  EXPECT_NE(told.find("too little"), std::string::npos) << told;
  const Merged merged = merge_maps(a, scene, Parameters{}, between(forth[0] * kMount, back[0] * kMount));
  EXPECT_LT(worst_error(merged.map, forth, back), 0.05);
}

TEST_F(MergeTest, WhatFewScansSayIsNotEnoughEvenWhereItIsSaidToLie) {
  const std::vector<Pose2> bit(back.begin(), back.begin() + 2);
  const Map scene = map_of(make_room(), bit, 1000.0, 2);
  EXPECT_NE(refusal(a, scene).find("--at X Y THETA"), std::string::npos);
  const std::string told = refusal(a, scene, between(forth[0] * kMount, back[0] * kMount));
  EXPECT_NE(told.find("not confirmed"), std::string::npos) << told;
  EXPECT_NE(told.find("--resume"), std::string::npos) << told;
  EXPECT_EQ(told.find("--at"), std::string::npos) << told;
}

TEST_F(MergeTest, AMapOfAnotherRoomIsRefused) {
  World other;
  testing::add_outline({{-2.4, -2.2}, {2.6, -2.2}, {2.6, 2.2}, {1.0, 2.2}, {-1.0, 3.6}, {-2.4, 2.6}}, other);
  testing::add_outline({{-0.5, -0.4}, {0.4, -0.2}, {0.2, 0.5}, {-0.4, 0.4}}, other);
  const std::string told = refusal(a, map_of(other, back, 1000.0, 2));
  EXPECT_NE(told.find("no place where the second map fits"), std::string::npos) << told;
  EXPECT_NE(told.find("--at"), std::string::npos);
}

TEST_F(MergeTest, ARoomThatIsThereTwiceIsAmbiguousUnlessThePlaceIsGiven) {
  const Pose2 T_first_second{12.0, 1.0, 0.5};
  const World world = joined(make_room(), testing::moved(make_room(), T_first_second));
  std::vector<Pose2> way = forth;
  for (const Pose2& pose : moved(forth, T_first_second)) way.push_back(pose);
  Map both;
  TrajectorySegments segments;
  std::vector<Pose2> places;
  for (std::size_t k = 0; k < way.size(); k += 5) places.push_back(way[k] * kMount);
  testing::append_chain(world, places, {}, both, segments);
  for (std::size_t k = 1; k < places.size(); ++k) {
    both.graph.edges.push_back(
        {k,
         k - 1,
         k,
         {0.0, k, between(places[k - 1], places[k]), 1e-4 * Eigen::Matrix3d::Identity(), ConstraintType::kLaser}});
  }
  const std::string told = refusal(both, b);
  EXPECT_NE(told.find("more than one place"), std::string::npos) << told;
  const Pose2 second = T_first_second * back[0] * kMount;
  const Merged merged = merge_maps(both, b, Parameters{}, second);
  const Pose2& found = merged.map.graph.nodes[merged.first_node_b].pose;
  EXPECT_LT(between(second, found).translation().norm(), 0.05);
}

}  // namespace
}  // namespace oort
