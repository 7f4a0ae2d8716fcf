// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Links between a node on the dock and the dock's own node.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "cloud_edits.hpp"
#include "datasets.hpp"
#include "mapping_fixtures.hpp"
#include "oort/loop_closure/dock_graph_builder.hpp"
#include "oort/storage/map_file.hpp"

namespace oort {
namespace {

class GenuineDockTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path folder = testing::datasets() / "kuri_oort_map";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << testing::not_found(folder);
    map = load_map(folder / "map");
  }
  Map map;
};

TEST_F(GenuineDockTest, MatchesTheDockAsTheOriginalDid) {
  const SwitchableEdge& original = map.graph.switchable_edges.at(0);
  ASSERT_EQ(original.i, 0u);
  ASSERT_EQ(original.j, 8u);
  for (const Parameters& parameters : {testing::documented_parameters(), Parameters()}) {
    ClosureCounts counts;
    const auto closure = DockGraphBuilder(parameters).find(map, TrajectorySegments::of_map(map), 8, counts);
    ASSERT_TRUE(closure);
    EXPECT_EQ(closure->from, 0u);
    EXPECT_EQ(closure->to, 8u);
    EXPECT_NEAR(closure->T_from_to.x, -0.0004, 0.01);
    EXPECT_NEAR(closure->T_from_to.y, -0.0056, 0.01);
    EXPECT_NEAR(closure->T_from_to.theta, -0.0887, 0.01);
    EXPECT_NEAR(closure->T_from_to.x, original.constraint.T_i_j.x, 0.01);
    EXPECT_GT(closure->inlier_ratio, 0.8);
    EXPECT_EQ(counts.tried, 1u);
    EXPECT_EQ(counts.accepted, 1u);
  }
}

TEST_F(GenuineDockTest, WithoutADockLocationTheFirstNodeOfTheChainCounts) {
  map.locations.clear();
  const TrajectorySegments segments = TrajectorySegments::of_map(map);
  EXPECT_EQ(nearest_dock(map, segments, 8).node, 0u);
  ClosureCounts counts;
  EXPECT_TRUE(DockGraphBuilder(Parameters()).find(map, segments, 8, counts));
}

TEST_F(GenuineDockTest, TheOriginalsDockClosureIsKnownAsOne) {
  make_dock_closures_firm(map, 50.0);
  EXPECT_EQ(map.graph.switchable_edges.at(0).firmness, 50.0);
}

TEST(NearestDock, IsADockLocationSeenFromItsNode) {
  Map map;
  TrajectorySegments segments;
  for (std::uint64_t k = 0; k < 10; ++k) {
    map.graph.nodes.push_back({k, {static_cast<double>(k), 0.0, 0.0}});
    segments.add(k == 5, true, {});
  }
  EXPECT_EQ(nearest_dock(map, segments, 9).node, 5u);  // the first of its segment
  map.locations = {
      {"dock", "hall", 1, {0.1, 0.2, 0.3}}, {"place", "sofa", 8, {}}, {"dock", "attic", 3, {0.0, 0.0, 3.0}}};
  EXPECT_EQ(nearest_dock(map, segments, 9).node, 3u);
  EXPECT_DOUBLE_EQ(nearest_dock(map, segments, 9).T_node_dock.theta, 3.0);
  EXPECT_EQ(nearest_dock(map, segments, 0).node, 1u);
  map.locations[2].T_node_location.x = -2.5;  // where the place is counts, not where its node is
  EXPECT_EQ(nearest_dock(map, segments, 2).node, 1u);
  EXPECT_EQ(nearest_dock(map, segments, 0).node, 3u);
}

/// Out from a dock and back onto it, in two segments: node 0 is the dock, the last node is on it again.
class DockTest : public ::testing::Test {
 protected:
  DockTest() {
    const std::vector<Pose2> truth = testing::laps(0.5);
    std::vector<Pose2> places;
    for (std::size_t k = 0; k < 60; k += 5) places.push_back(truth[k]);
    testing::append_chain(testing::make_room(), places, {}, map, segments);
    std::reverse(places.begin(), places.end());
    places.back() = dock() * kDocked;
    testing::append_chain(testing::make_room(), places, {}, map, segments);
    query = map.graph.nodes.back().id;
    map.graph.nodes.back().pose = dock() * Pose2{3.0, 2.0, 1.0};  // however wrong the graph is by then
    map.locations = {{"dock", "dock", 0, {}}};
  }

  Pose2 dock() const { return map.graph.nodes[0].pose; }

  std::optional<Closure> find() {
    counts = {};
    return DockGraphBuilder(parameters).find(map, segments, query, counts);
  }
  Rejection verdict() {
    if (find()) return Rejection::kNone;
    const auto rejected = counts.rejected.by_text();
    EXPECT_EQ(rejected.size(), 1u);
    return rejected.front().first;
  }

  const Pose2 kDocked{0.05, -0.03, 0.06};
  Map map;
  TrajectorySegments segments;
  std::uint64_t query = 0;
  Parameters parameters = testing::documented_parameters();
  DockGraphBuilderParameters& p = parameters.dock_graph_builder;
  ClosureCounts counts;
};

TEST_F(DockTest, IsMeasuredWhereverTheGraphPutsTheRobot) {
  const std::optional<Closure> closure = find();
  ASSERT_TRUE(closure);
  EXPECT_EQ(closure->from, 0u);
  EXPECT_EQ(closure->to, query);
  EXPECT_NEAR(closure->T_from_to.x, kDocked.x, 0.01);
  EXPECT_NEAR(closure->T_from_to.y, kDocked.y, 0.01);
  EXPECT_NEAR(closure->T_from_to.theta, kDocked.theta, 0.01);
  EXPECT_GT(closure->covariance.determinant(), 0.0);
}

TEST_F(DockTest, HitsAndDistanceAreLimited) {
  const Closure closure = find().value();
  p.dock_match_min_hit_pct = closure.inlier_ratio;
  EXPECT_EQ(verdict(), Rejection::kNone);
  p.dock_match_min_hit_pct = closure.inlier_ratio + 1e-9;
  EXPECT_EQ(verdict(), Rejection::kHits);
  p.dock_match_min_hit_pct = 0.0;
  const double distance = closure.T_from_to.translation().norm();
  p.dock_match_max_dist = distance + 1e-9;
  EXPECT_EQ(verdict(), Rejection::kNone);
  p.dock_match_max_dist = distance - 1e-9;
  EXPECT_EQ(verdict(), Rejection::kDistance);
}

TEST_F(DockTest, DistanceIsFromTheDockNotFromItsNode) {
  map.locations = {{"dock", "dock", 4, between(map.graph.nodes[4].pose, dock())}};
  p.dock_match_max_dist = kDocked.translation().norm() + 0.01;
  const std::optional<Closure> closure = find();
  ASSERT_TRUE(closure);
  EXPECT_EQ(closure->from, 4u);
  const Pose2 error = between(dock() * kDocked, map.graph.nodes[4].pose * closure->T_from_to);
  EXPECT_NEAR(error.translation().norm(), 0.0, 0.01);
}

TEST_F(DockTest, WhereTheLastNodesAreBentFewerAreMatched) {
  segments = {};  // the same places again, but the robot took its last turn but one for a much wider one
  for (std::uint64_t k = 0; k < map.graph.nodes.size(); ++k) {
    const Pose2 T_bent = k < query - 2 ? Pose2{0.3, -0.2, 0.5} : Pose2{};
    const Pose2 place = k == query ? dock() * kDocked : map.graph.nodes[k].pose;
    segments.add(k == 0 || k == 12, true, k < 12 ? place : T_bent * place);
  }
  p.dock_match_least_size = p.dock_match_submap_size;
  EXPECT_EQ(verdict(), Rejection::kHits);
  p.dock_match_least_size = 1;
  const std::optional<Closure> closure = find();
  ASSERT_TRUE(closure);
  EXPECT_EQ(counts.tried, 1u);
  EXPECT_EQ(counts.rejected.total(), 0u);
  EXPECT_NEAR(closure->T_from_to.x, kDocked.x, 0.01);
  EXPECT_NEAR(closure->T_from_to.y, kDocked.y, 0.01);
  EXPECT_NEAR(closure->T_from_to.theta, kDocked.theta, 0.01);
}

// Of the 24 nodes of this drive the last ones are bent; matched with those just before them they would fit.
TEST_F(DockTest, TheWayBackDoesNotStandForTheDock) {
  segments = {};
  const Pose2 T_bent{0.1, -0.05, 0.2};
  for (std::uint64_t k = 0; k < map.graph.nodes.size(); ++k) {
    const Pose2 place = k == query ? dock() * kDocked : map.graph.nodes[k].pose;
    segments.add(k == 0, true, k < query - 10 ? place : T_bent * place);
  }
  p.dock_match_least_size = 1;
  const std::optional<Closure> closure = find();
  ASSERT_TRUE(closure);
  EXPECT_NEAR(closure->T_from_to.x, kDocked.x, 0.02);
  EXPECT_NEAR(closure->T_from_to.y, kDocked.y, 0.02);
  EXPECT_NEAR(closure->T_from_to.theta, kDocked.theta, 0.02);
}

TEST_F(DockTest, ThatOneNodeIsAllThereIsMakesItNoBetter) {
  const std::optional<Closure> whole = find();
  ASSERT_TRUE(whole);
  segments = {};  // the last node stands alone: what is before it is of another session
  for (const Node& node : map.graph.nodes) segments.add(node.id == 0 || node.id == query, true, node.pose);
  PointCloud seen = map.clouds[query];
  for (std::size_t k = 0; k < 60; ++k) {  // a third of what it sees has changed
    seen.points[k].x *= 0.6;
    seen.points[k].y *= 0.6;
  }
  map.clouds.set(query, seen);
  EXPECT_TRUE(find());  // as documented
  p.dock_match_least_size = 1;
  EXPECT_EQ(verdict(), Rejection::kHits);
}

TEST_F(DockTest, OnlyWhatWasMatchedIsFirm) {
  const Eigen::Matrix3d documented = find().value().covariance;
  EXPECT_EQ(find()->firmness, 1.0);
  p.closure_firmness = 70.0;
  EXPECT_EQ(find()->firmness, 70.0);
  EXPECT_GT((find()->covariance - documented).determinant(), 0.0);
  testing::edit_cloud(map.clouds, query, [](PointCloud& cloud) { cloud.points.resize(3); });
  p.dock_match_submap_size = 1;
  EXPECT_EQ(find()->firmness, 1.0);
}

TEST_F(DockTest, ALoadedMapsDockClosuresAreKnownByTheirDirection) {
  const auto add = [this](std::uint64_t i, std::uint64_t j, double hits) {
    map.graph.switchable_edges.push_back({map.graph.switchable_edges.size(), i, j, {}});
    map.loop_results.push_back({i, j, {}, Eigen::Matrix3d::Identity(), hits});
  };
  add(0, query, 0.9);
  add(query, 0, 0.9);      // a loop
  add(0, query - 1, 0.0);  // the reach of the contacts
  make_dock_closures_firm(map, 50.0);
  EXPECT_EQ(map.graph.switchable_edges[0].firmness, 50.0);
  EXPECT_EQ(map.graph.switchable_edges[1].firmness, 1.0);
  EXPECT_EQ(map.graph.switchable_edges[2].firmness, 1.0);
}

TEST_F(DockTest, SomewhereElseIsNotTheDock) {
  const Pose2 elsewhere = dock() * Pose2{1.5, 0.8, 1.5};
  map.clouds.set(query, to_point_cloud(testing::see(testing::make_room(), elsewhere, 9.0)));
  p.dock_match_submap_size = 1;  // only what is seen now
  EXPECT_FALSE(find());
}

TEST_F(DockTest, WhereNothingIsSeenTheContactsCount) {
  testing::edit_cloud(map.clouds, query, [](PointCloud& cloud) { cloud.points.resize(3); });
  p.dock_match_submap_size = 1;
  const std::optional<Closure> closure = find();
  ASSERT_TRUE(closure);
  EXPECT_EQ(closure->T_from_to.x, 0.0);
  EXPECT_EQ(closure->inlier_ratio, 0.0);
  const double reach = p.dock_contacts_size + p.dock_max_translation;
  EXPECT_NEAR(closure->covariance(0, 0), reach * reach, 1e-12);
  EXPECT_EQ(counts.accepted, 1u);
  p.closure_firmness = 100.0;  // the reach is a limit, two deviations away
  EXPECT_NEAR(find()->covariance(0, 0), 0.25 * reach * reach, 1e-12);
}

TEST_F(DockTest, TheDocksOwnNodeIsNoClosure) {
  query = 0;
  EXPECT_EQ(verdict(), Rejection::kSameNode);
  query = 1;  // all that was seen is the query's own submap
  segments = {};
  map.graph.nodes.resize(2);
  segments.add(true, true, {});
  segments.add(false, true, {0.2, 0.0, 0.0});
  EXPECT_EQ(verdict(), Rejection::kNoReference);
}

}  // namespace
}  // namespace oort
