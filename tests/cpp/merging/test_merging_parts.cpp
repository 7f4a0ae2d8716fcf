// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// What merging rests on: maps put together, views of a map, and closures to earlier nodes only.
#include <gtest/gtest.h>

#include "localization_fixtures.hpp"
#include "oort/loop_closure/loop_closure_builder.hpp"
#include "oort/map/map_check.hpp"
#include "oort/merging/internal/append_map.hpp"
#include "oort/merging/internal/map_views.hpp"
#include "oort/merging/map_placement.hpp"

namespace oort {
namespace {

using testing::make_room;
using testing::views_of_room;

/// A map with something of everything.
Map small_map(const Pose2& T_world_map = {}) {
  Map map;
  TrajectorySegments segments;
  std::vector<Pose2> places = views_of_room();
  places.resize(5);
  testing::append_chain(make_room(), places, {}, map, segments);
  for (Node& node : map.graph.nodes) node.pose = inverse(T_world_map) * node.pose;
  const Eigen::Matrix3d covariance = 1e-4 * Eigen::Matrix3d::Identity();
  for (std::uint64_t k = 1; k < 5; ++k) {
    const Pose2 step = between(places[k - 1], places[k]);
    map.graph.edges.push_back({2 * k, k - 1, k, {map.clouds[k].time, k, step, covariance, ConstraintType::kLaser}});
    map.incremental_results.push_back({k, k - 1, places[k], covariance, step, 0.9});
  }
  const Pose2 loop = between(places[4], places[0]);
  map.graph.switchable_edges.push_back(
      {9, 4, 0, {map.clouds[4].time, 4, loop, covariance, ConstraintType::kLaser}, 0.5});
  map.loop_results.push_back({4, 0, loop, covariance, 0.8});
  map.locations.push_back({"room", "door", 3, {0.1, 0.2, 0.3}});
  return map;
}

TEST(AppendMap, CountsAllIdsOn) {
  const Pose2 T_a_b{3.0, -1.0, 2.0};
  Map map = small_map();
  const Map other = small_map(T_a_b);
  EXPECT_EQ(append_map(other, T_a_b, map), 5u);
  EXPECT_FALSE(find_defect(map));
  ASSERT_EQ(map.graph.nodes.size(), 10u);
  for (std::size_t k = 0; k < 5; ++k) {
    const Pose2 apart = between(map.graph.nodes[k].pose, map.graph.nodes[k + 5].pose);
    EXPECT_LT(apart.translation().norm() + std::abs(apart.theta), 1e-9);
    EXPECT_EQ(map.clouds[k + 5].id, k + 5);
    EXPECT_EQ(map.clouds[k + 5].points.size(), other.clouds[k].points.size());
  }
  ASSERT_EQ(map.graph.edges.size(), 8u);
  EXPECT_EQ(map.graph.edges[4].i, 5u);
  EXPECT_EQ(map.graph.edges[4].j, 6u);
  EXPECT_EQ(map.graph.edges[4].constraint.id, 6u);
  EXPECT_EQ(map.graph.edges[4].id, 12u);
  EXPECT_EQ(map.graph.switchable_edges[1].i, 9u);
  EXPECT_EQ(map.graph.switchable_edges[1].j, 5u);
  EXPECT_EQ(map.graph.switchable_edges[1].switch_value, 0.5);
  EXPECT_EQ(next_edge_id(map.graph), 20u);
  EXPECT_EQ(map.incremental_results[4].id, 6u);
  EXPECT_EQ(map.incremental_results[4].target, 5u);
  EXPECT_EQ(map.loop_results[1].id, 9u);
  EXPECT_EQ(map.loop_results[1].target, 5u);
  EXPECT_EQ(map.locations[1].node_id, 8u);
}

TEST(AppendMap, SegmentsStayWhatTheyWere) {
  Map map = small_map();
  append_map(small_map(), {}, map);
  const TrajectorySegments segments = TrajectorySegments::of_map(map);
  EXPECT_EQ(segments.segment_begin(4), 0u);
  EXPECT_EQ(segments.segment_begin(5), 5u);
  EXPECT_EQ(segments.segment_begin(9), 5u);
  const TrajectorySegments alone = TrajectorySegments::of_map(small_map());
  EXPECT_LT(between(alone.local_pose(4), segments.local_pose(9)).translation().norm(), 1e-12);
}

TEST(CommonScans, AreThoseOfTheSameTimeAndPoints) {
  const Map map = small_map();
  EXPECT_EQ(count_common_scans(map, map), 5u);  // bearings of what is no return are nan, and still the same
  Map other = map;
  std::vector<PointCloud> changed(map.clouds.begin(), map.clouds.end());
  changed[0].time += 0.5;
  changed[1].points[7].x += 0.01;
  changed[2].points.pop_back();
  other.clouds = changed;
  EXPECT_EQ(count_common_scans(map, other), 2u);
  EXPECT_EQ(count_common_scans(map, Map{}), 0u);
  for (PointCloud& cloud : changed) cloud.points.clear();
  other.clouds = changed;
  EXPECT_EQ(count_common_scans(other, other), 0u) << "what saw nothing is alike on any drive";
}

TEST(SpreadViews, CoverTheMapEvenly) {
  Map map;
  TrajectorySegments segments;
  testing::append_chain(make_room(), views_of_room(), {}, map, segments);
  const std::vector<MapView> views = spread_views(map, segments, 100, 0.7, 5);
  EXPECT_GT(views.size(), 5u);
  for (const MapView& view : views) {
    EXPECT_LE(view.scans.size(), 5u);
    for (const MapView& other : views) {
      if (view.node == other.node) continue;
      EXPECT_GE((map.graph.nodes[view.node].pose.translation() - map.graph.nodes[other.node].pose.translation()).norm(),
                0.7);
    }
  }
  for (const Node& node : map.graph.nodes) {
    EXPECT_TRUE(std::any_of(views.begin(), views.end(), [&](const MapView& view) {
      return (map.graph.nodes[view.node].pose.translation() - node.pose.translation()).norm() < 0.7;
    }));
  }
  EXPECT_EQ(spread_views(map, segments, 3, 0.7, 5).size(), 3u);
  EXPECT_TRUE(spread_views(Map{}, TrajectorySegments{}, 3, 0.7, 5).empty());
}

TEST(MapPlacement, ASmallMapIsFoundOnALargeOneAndTheOtherWayRound) {
  Map large;
  TrajectorySegments segments;
  testing::append_chain(make_room(), views_of_room(), {}, large, segments);
  const Eigen::Matrix3d covariance = 1e-4 * Eigen::Matrix3d::Identity();
  for (std::uint64_t k = 1; k < large.graph.nodes.size(); ++k) {
    const Pose2 step = between(large.graph.nodes[k - 1].pose, large.graph.nodes[k].pose);
    large.graph.edges.push_back({k, k - 1, k, {0.0, k, step, covariance, ConstraintType::kLaser}});
  }
  const Pose2 T_large_small{3.0, -1.0, 2.0};
  const Map small = small_map(T_large_small);
  for (const bool swap : {false, true}) {
    const MapSearch search = swap ? find_placements(small, large, Parameters{}, {}, false)
                                  : find_placements(large, small, Parameters{}, {}, false);
    ASSERT_FALSE(search.placements.empty());
    const MapPlacement& best = search.placements.front();
    const Pose2 truth = swap ? inverse(T_large_small) : T_large_small;
    EXPECT_LT(between(truth, best.T_a_b).translation().norm(), 0.05);
    EXPECT_EQ(best.fits, search.views);
    EXPECT_EQ(best.contradicts, 0);
    EXPECT_LT(swap ? best.node_a : best.node_b, 5u);
  }
}

TEST(LoopClosureBuilder, LooksForEarlierNodesOnlyWhereAsked) {
  Map map;
  TrajectorySegments segments;
  testing::append_chain(make_room(), views_of_room(), {}, map, segments);
  const std::uint64_t second = map.graph.nodes.size();
  testing::append_chain(make_room(), views_of_room(), {}, map, segments);
  Parameters parameters;
  parameters.loop_closure_graph_builder.candidate_search.knearest_neighbors = 100;
  const LoopClosureBuilder loops(parameters);
  const std::vector<std::uint64_t> all = loops.candidates(map, segments, second + 20);
  const std::vector<std::uint64_t> before = loops.candidates(map, segments, second + 20, second);
  EXPECT_FALSE(before.empty());
  EXPECT_LT(before.size(), all.size());
  EXPECT_TRUE(std::all_of(before.begin(), before.end(), [&](std::uint64_t node) { return node < second; }));
}

}  // namespace
}  // namespace oort
