// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// What the mapper does beside taking scans: the dock, sessions, pauses and named places.
#include <gtest/gtest.h>

#include "mapping_fixtures.hpp"
#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

using testing::drive;
using testing::kMount;
using testing::laps;
using testing::make_room;
using testing::odometry_of;
using testing::World;

class MapperCallsTest : public ::testing::Test {
 protected:
  /// Drives a lap that ends where it began, or near it, with a dock there.
  void drive_lap() {
    drive(mapper, world, {truth.begin(), truth.begin() + 2}, {odometry.begin(), odometry.begin() + 2});
    mapper.create_location("dock", "dock", mapper.sensor_pose());
    drive(mapper, world, {truth.begin() + 2, truth.end()}, {odometry.begin() + 2, odometry.end()}, 100.2);
  }
  const Map& map() const { return mapper.map(); }

  const World world = make_room();
  const std::vector<Pose2> truth = laps(1.0);
  const std::vector<Pose2> odometry = odometry_of(truth, 0.03, 0.02);
  Mapper mapper{Parameters(), kMount};
};

TEST_F(MapperCallsTest, NotifyDockedMakesANodeAndOneSwitchableEdge) {
  drive_lap();
  const std::size_t nodes = map().graph.nodes.size();
  const std::size_t closures = map().graph.switchable_edges.size();
  ASSERT_LT(map().clouds.back().time, 100.0 + 0.1 * static_cast<double>(truth.size() - 1) - 0.05)
      << "the last scan must not be a node yet, else nothing is shown";
  EXPECT_TRUE(mapper.notify_docked());
  ASSERT_EQ(map().graph.nodes.size(), nodes + 1);
  EXPECT_NEAR(map().clouds.back().time, 100.0 + 0.1 * static_cast<double>(truth.size() - 1), 1e-6);
  ASSERT_EQ(map().graph.switchable_edges.size(), closures + 1);
  const SwitchableEdge& edge = map().graph.switchable_edges.back();
  EXPECT_EQ(edge.i, map().locations.front().node_id);
  EXPECT_EQ(edge.j, nodes);
  EXPECT_EQ(edge.constraint.id, edge.i);
  EXPECT_EQ(edge.constraint.time, map().clouds[edge.i].time);
  EXPECT_EQ(map().loop_results.back().id, edge.i);
  EXPECT_EQ(map().loop_results.back().target, edge.j);
  const Pose2 expected = between(truth[0] * kMount, truth.back() * kMount);
  EXPECT_LT(between(expected, edge.constraint.T_i_j).translation().norm(), 0.02);
  EXPECT_EQ(mapper.statistics().global.docks.tried, 1u);
  EXPECT_EQ(mapper.statistics().global.docks.accepted, 1u);
}

TEST_F(MapperCallsTest, AParkedRobotIsLinkedOnce) {
  drive_lap();
  const std::size_t nodes = map().graph.nodes.size();
  for (int k = 0; k < 200; ++k) {
    EXPECT_TRUE(mapper.notify_docked());
    drive(mapper, world, {truth.back()}, {odometry.back()}, 200.0 + 0.1 * k);
  }
  EXPECT_EQ(map().graph.nodes.size(), nodes + 1);
  EXPECT_EQ(mapper.statistics().global.docks.tried, 1u);
  EXPECT_EQ(mapper.statistics().global.docks.accepted, 1u);
}

TEST_F(MapperCallsTest, WhereTheDockIsNotFoundAParkedRobotIsTriedAgainWithoutANewNode) {
  const auto half = static_cast<std::ptrdiff_t>(truth.size() / 2);
  drive(mapper, world, {truth.begin(), truth.begin() + half}, {odometry.begin(), odometry.begin() + half});
  EXPECT_FALSE(mapper.notify_docked());
  const std::size_t nodes = map().graph.nodes.size();
  EXPECT_FALSE(mapper.notify_docked());
  EXPECT_EQ(map().graph.nodes.size(), nodes);
  EXPECT_EQ(mapper.statistics().global.docks.tried, 2u);
}

TEST_F(MapperCallsTest, TheDockIsLookedForBesideTheScansToCome) {
  drive_lap();
  EXPECT_EQ(mapper.dock_closure_found(), std::nullopt);
  mapper.request_dock_closure();
  mapper.request_dock_closure();  // still there: one is enough
  EXPECT_EQ(mapper.dock_closure_found(), std::nullopt);
  int scans = 0;
  for (; scans < 100 && !mapper.dock_closure_found(); ++scans) {
    drive(mapper, world, {truth.back()}, {odometry.back()}, 200.0 + 0.1 * scans);
  }
  EXPECT_GT(scans, 2);
  EXPECT_EQ(mapper.dock_closure_found(), std::optional<bool>(true));
  EXPECT_EQ(mapper.statistics().global.docks.accepted, 1u);
}

TEST_F(MapperCallsTest, WhatIsLeftToLookForAtTheDockIsDoneWhenMappingEnds) {
  drive_lap();
  mapper.request_dock_closure();
  mapper.finish();
  EXPECT_EQ(mapper.dock_closure_found(), std::optional<bool>(true));
}

TEST_F(MapperCallsTest, NotifyDockedSomewhereElseChangesNoPose) {
  const auto half = static_cast<std::ptrdiff_t>(truth.size() / 2);
  drive(mapper, world, {truth.begin(), truth.begin() + half}, {odometry.begin(), odometry.begin() + half});
  const Pose2 before = mapper.sensor_pose();
  const std::size_t closures = map().graph.switchable_edges.size();
  EXPECT_FALSE(mapper.notify_docked());
  EXPECT_EQ(map().graph.switchable_edges.size(), closures);
  EXPECT_LT(between(before, mapper.sensor_pose()).translation().norm(), 1e-9);
  EXPECT_EQ(mapper.statistics().global.docks.accepted, 0u);
  EXPECT_EQ(mapper.statistics().global.docks.rejected.by_text().size(), 1u);
}

TEST_F(MapperCallsTest, ADockClosureThatAllElseContradictsGoesOff) {
  Parameters credulous;  // whatever the last nodes look like, they are at the dock
  credulous.dock_graph_builder.dock_match_min_hit_pct = 0.0;
  Mapper misled{credulous, kMount};
  const std::vector<Pose2> way = laps(2.5);
  drive(misled, world, way, odometry_of(way, 0.03, 0.02));
  const Pose2 before = misled.sensor_pose();
  EXPECT_TRUE(misled.notify_docked());
  const SwitchableEdge& edge = misled.map().graph.switchable_edges.back();
  EXPECT_EQ(edge.firmness, credulous.dock_graph_builder.closure_firmness);
  EXPECT_FALSE(edge.is_on());
  EXPECT_LT(between(before, misled.sensor_pose()).translation().norm(), 0.02);
}

TEST_F(MapperCallsTest, ALoadedMapsDockClosureIsAsFirmAsWhenItWasMade) {
  drive_lap();
  ASSERT_TRUE(mapper.notify_docked());
  Map loaded = map();
  for (SwitchableEdge& edge : loaded.graph.switchable_edges) edge.firmness = 1.0;  // map files do not tell
  Mapper later{Parameters(), kMount};
  later.set_map(loaded);
  for (std::size_t k = 0; k < loaded.graph.switchable_edges.size(); ++k) {
    EXPECT_EQ(later.map().graph.switchable_edges[k].firmness, map().graph.switchable_edges[k].firmness) << k;
  }
}

TEST_F(MapperCallsTest, NotifyDockedBeforeAnyScanIsAnError) {
  EXPECT_THROW(mapper.notify_docked(), StateError);
}

TEST_F(MapperCallsTest, PauseLinkIsInflated) {
  const std::vector<Pose2> before(truth.begin(), truth.begin() + 40);
  const std::vector<Pose2> after(truth.begin() + 45, truth.begin() + 70);
  drive(mapper, world, before, before);
  const std::size_t nodes = map().graph.nodes.size();
  mapper.resume_from_paused();
  EXPECT_FALSE(mapper.has_pose());  // nothing links the robot to the map by now
  drive(mapper, world, after, after, 200.0);
  const Edge& link = map().graph.edges[nodes - 1];
  EXPECT_EQ(link.i, nodes - 1);
  EXPECT_EQ(link.j, nodes);
  EXPECT_EQ(link.constraint.type, ConstraintType::kOdometry);
  EXPECT_NEAR(map().clouds[nodes].time, 200.0, 1e-9);  // the first scan makes a node
  const double scale = Parameters().incremental_graph_builder.frsm_matcher.inflate_scanmatch_cov_scale;
  for (int k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(link.constraint.covariance(k, k), 0.1 * scale * scale);
  EXPECT_LT(map().graph.edges[nodes].constraint.covariance(0, 0), 0.1);   // only that link
  const Pose2 expected = between(truth[0] * kMount, truth[45] * kMount);  // odometry goes on while it pauses
  EXPECT_LT(between(expected, map().graph.nodes[nodes].pose).translation().norm(), 0.02);
}

TEST_F(MapperCallsTest, PauseBeforeTheFirstNodeChangesNothing) {
  mapper.resume_from_paused();
  drive(mapper, world, {truth.begin(), truth.begin() + 20}, {truth.begin(), truth.begin() + 20});
  EXPECT_EQ(map().graph.edges.size() + 1, map().graph.nodes.size());
  for (const Edge& edge : map().graph.edges) EXPECT_EQ(edge.constraint.type, ConstraintType::kLaser);
}

TEST_F(MapperCallsTest, RobotThatWasCarriedWhilePausedIsFoundAgain) {
  drive(mapper, world, truth, truth);
  const std::size_t nodes = map().graph.nodes.size();
  mapper.resume_from_paused();
  // Taken 0.5 m aside and turned; odometry did not notice.
  const Pose2 T_true_odom{0.3, 0.4, 0.15};
  std::vector<Pose2> again(truth.begin() + 10, truth.begin() + 110);
  std::vector<Pose2> odometry;
  for (const Pose2& pose : again) odometry.push_back(inverse(T_true_odom) * pose);
  drive(mapper, world, again, odometry, 300.0);
  mapper.finish();
  EXPECT_GT(mapper.statistics().global.loops.accepted, 0u);
  const Pose2 expected = between(truth[0] * kMount, again.back() * kMount);
  EXPECT_LT(between(expected, mapper.sensor_pose()).translation().norm(), 0.05);
  EXPECT_GT(map().graph.nodes.size(), nodes + 10);
}

TEST_F(MapperCallsTest, SessionBeginsASegmentThatIsLinkedLoosely) {
  drive(mapper, world, truth, truth);
  mapper.finish();
  const Map old = map();
  Mapper next(Parameters(), kMount);
  next.set_map(old);
  EXPECT_FALSE(next.has_pose());
  const Pose2 start = between(truth[0] * kMount, truth[30] * kMount);
  next.begin_session(start * Pose2{0.1, -0.15, 0.08});  // "about"
  std::vector<Pose2> again(truth.begin() + 30, truth.begin() + 130);
  drive(next, world, again, odometry_of(again, 0.0, 0.0), 1000.0);
  next.finish();

  const std::size_t first = old.graph.nodes.size();
  const Map& map = next.map();
  ASSERT_GT(map.graph.nodes.size(), first + 10);
  const auto joins = [&](const Edge& edge) { return (edge.i < first) != (edge.j < first); };
  ASSERT_EQ(std::count_if(map.graph.edges.begin(), map.graph.edges.end(), joins), 1);
  const Edge& link = *std::find_if(map.graph.edges.begin(), map.graph.edges.end(), joins);
  EXPECT_EQ(link.j, first);
  const double scale = Parameters().incremental_graph_builder.frsm_matcher.resume_scanmatch_cov_scale;
  EXPECT_DOUBLE_EQ(link.constraint.covariance(0, 0), 0.1 * scale * scale);
  EXPECT_LT((map.graph.nodes[link.i].pose.translation() - start.translation()).norm(), 0.4);  // the nearest
  EXPECT_EQ(map.incremental_results[first].target, first);
  for (std::size_t k = 0; k < old.graph.edges.size(); ++k) EXPECT_EQ(map.graph.edges[k].id, old.graph.edges[k].id);
  EXPECT_GE(link.id, old.graph.edges.size() + old.graph.switchable_edges.size());

  const Pose2 expected = between(truth[0] * kMount, again.back() * kMount);
  EXPECT_LT(between(expected, next.sensor_pose()).translation().norm(), 0.05);
  for (std::size_t k = 0; k < first; ++k) {  // a guess that was off does not bend the old part
    EXPECT_LT((map.graph.nodes[k].pose.translation() - old.graph.nodes[k].pose.translation()).norm(), 0.03);
  }
}

TEST_F(MapperCallsTest, SessionOnAnEmptyMapBeginsAtTheOrigin) {
  mapper.begin_session({5.0, 5.0, 1.0});
  drive(mapper, world, {truth[0]}, {truth[0]});
  EXPECT_EQ(map().graph.nodes.at(0).pose.x, 0.0);
}

TEST_F(MapperCallsTest, LocationsFollowTheirNodes) {
  drive_lap();
  mapper.create_location("place", "sofa", mapper.sensor_pose() * Pose2{0.5, 0.2, 1.0});
  mapper.create_points({"spots", "spots"}, {{0.2, 0.1}, {0.6, 0.3}}, {"a", "b"});
  const Map before = map();
  const Pose2 sofa_before = mapper.locate("place", "sofa").value();
  mapper.notify_docked();
  mapper.finish();
  const Map& after = map();
  for (std::size_t k = 0; k < before.locations.size(); ++k) {
    const Location& location = after.locations[k];
    EXPECT_EQ(location.node_id, before.locations[k].node_id);
    const Pose2 expected = after.graph.nodes[location.node_id].pose * location.T_node_location;
    const Pose2 actual = mapper.locate(location.name_space, location.id).value();
    EXPECT_DOUBLE_EQ(actual.x, expected.x);
    EXPECT_DOUBLE_EQ(actual.theta, expected.theta);
  }
  const std::uint64_t node = after.locations[1].node_id;
  ASSERT_NE(before.graph.nodes[node].pose.x, after.graph.nodes[node].pose.x) << "nothing moved, so nothing is shown";
  EXPECT_NE(mapper.locate("place", "sofa")->x, sofa_before.x);
}

TEST_F(MapperCallsTest, LocationsAreRelativeToTheNearestNode) {
  drive(mapper, world, {truth.begin(), truth.begin() + 60}, {truth.begin(), truth.begin() + 60});
  const Pose2 place = map().graph.nodes[3].pose * Pose2{0.02, 0.03, 2.0};
  mapper.create_location("place", "here", place);
  EXPECT_EQ(map().locations.at(0).node_id, 3u);
  EXPECT_NEAR(map().locations[0].T_node_location.theta, 2.0, 1e-12);
  mapper.create_location("place", "here", map().graph.nodes[5].pose);  // again: moved
  ASSERT_EQ(map().locations.size(), 1u);
  EXPECT_EQ(map().locations[0].node_id, 5u);
  // Points far apart share the node nearest to their centroid and look along the map's x axis.
  const Eigen::Vector2d middle = map().graph.nodes[2].pose.translation();
  mapper.create_points({"p", "q"}, {middle + Eigen::Vector2d(1.0, 0.0), middle - Eigen::Vector2d(1.0, 0.0)},
                       {"a", "b"});
  EXPECT_EQ(map().locations[1].node_id, 2u);
  EXPECT_EQ(map().locations[2].node_id, 2u);
  EXPECT_NEAR(mapper.locate("q", "b")->theta, 0.0, 1e-12);
  EXPECT_NEAR(mapper.locate("q", "b")->x, middle.x() - 1.0, 1e-12);
  EXPECT_TRUE(mapper.delete_location("p", "a"));
  EXPECT_FALSE(mapper.delete_location("p", "a"));
  EXPECT_FALSE(mapper.locate("p", "a"));
}

TEST_F(MapperCallsTest, LocationsThatCannotBeAreRefused) {
  EXPECT_THROW(mapper.create_location("place", "x", {}), StateError);
  drive(mapper, world, {truth[0]}, {truth[0]});
  EXPECT_THROW(mapper.create_location("place", "x", {NAN, 0.0, 0.0}), InputError);
  EXPECT_THROW(mapper.create_points({"p"}, {{INFINITY, 0.0}}, {"a"}), InputError);
  EXPECT_THROW(mapper.create_points({"p", "p"}, {{0.0, 0.0}}, {"a"}), InputError);
  EXPECT_TRUE(map().locations.empty());
}

}  // namespace
}  // namespace oort
