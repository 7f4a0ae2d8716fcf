// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/prune.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mapping_fixtures.hpp"
#include "oort/graph/relative_uncertainty.hpp"
#include "oort/maintenance/outdated.hpp"
#include "oort/maintenance/view_selection.hpp"
#include "oort/map/locations.hpp"
#include "oort/map/map_check.hpp"

namespace oort {
namespace {

using testing::add_outline;
using testing::append_chain;
using testing::drive;
using testing::kMount;
using testing::laps;
using testing::make_room;
using testing::odometry_of;
using testing::World;

/// A map of sessions of laps around the room, each gone on with at the start. Nothing is pruned on the way.
Map map_of_sessions(int sessions) {
  Parameters parameters;
  parameters.keep_views = 0;
  Mapper mapper(parameters, kMount);
  const std::vector<Pose2> truth = laps(2.0);
  for (int session = 0; session < sessions; ++session) {
    if (session > 0) mapper.begin_session(Pose2{});
    drive(mapper, make_room(), truth, odometry_of(truth, 0.01, 0.01, static_cast<std::uint64_t>(session + 1)));
    if (session == 0) mapper.create_location("place", "here", mapper.sensor_pose());
    mapper.finish();
  }
  return mapper.map();
}

const Map& three_sessions() {
  static const Map map = map_of_sessions(3);
  return map;
}

double sigma_of(const Map& map, std::uint64_t from, std::uint64_t to) {
  RelativeUncertainty uncertainty;
  uncertainty.update(map.graph);
  return std::sqrt(uncertainty.from(map.graph, from)[to]->topLeftCorner<2, 2>().trace());
}

TEST(Prune, KeepsAsMuchOfThreeSessionsAsOfOne) {
  const Pruned one = prune_grown(map_of_sessions(1), 3);
  const Pruned three = prune_grown(three_sessions(), 3);
  EXPECT_LT(three.map.graph.nodes.size(), three_sessions().graph.nodes.size() / 2);
  EXPECT_LT(three.map.graph.nodes.size(), 1.3 * static_cast<double>(one.map.graph.nodes.size()));
  EXPECT_LT(three.map.graph.switchable_edges.size(), 3 * three.map.graph.nodes.size());
}

TEST(Prune, LeavesASoundMapWithPosesAndPlacesWhereTheyWere) {
  const Map& map = three_sessions();
  const Pruned pruned = prune_grown(map, 3);
  EXPECT_EQ(find_defect(pruned.map), std::nullopt);
  ASSERT_EQ(pruned.nodes.carrier.size(), map.graph.nodes.size());
  for (const Edge& edge : pruned.map.graph.edges) EXPECT_LT(edge.i, edge.j);
  const Pose2 before = *locate(map, "place", "here"), after = *locate(pruned.map, "place", "here");
  EXPECT_EQ(before.x, after.x);
  EXPECT_EQ(before.y, after.y);
  EXPECT_EQ(pruned.map.clouds.size(), pruned.map.graph.nodes.size());
  EXPECT_EQ(pruned.map.incremental_results.size(), pruned.map.graph.nodes.size());
  EXPECT_EQ(pruned.map.loop_results.size(), pruned.map.graph.switchable_edges.size());
}

TEST(Prune, WhatIsKeptStaysTiedAndBecomesNoMoreCertain) {
  const Map& map = three_sessions();
  const std::vector<bool> kept = select_views(map, TrajectorySegments::of_map(map), 3);
  const Pruned pruned = prune_grown(map, 3);
  std::uint64_t last = 0;
  for (std::uint64_t node = 0; node < kept.size(); ++node) {
    if (kept[node]) last = node;
  }
  const double before = sigma_of(map, 0, last), after = sigma_of(pruned.map, 0, pruned.nodes.carrier[last]);
  EXPECT_GE(after, 0.999 * before);
  EXPECT_LT(after, 3.0 * before + 0.02);
}

TEST(Prune, SolvingTheReducedGraphMovesLittle) {
  Map map = prune_grown(three_sessions(), 3).map;
  const Graph before = map.graph;
  const OptimizerSummary summary = optimize(map.graph, OptimizerOptions{});
  EXPECT_TRUE(summary.converged);
  for (const Node& node : map.graph.nodes) {
    EXPECT_LT((node.pose.translation() - before.nodes[node.id].pose.translation()).norm(), 0.02);
  }
}

TEST(Prune, ASecondTimeFindsNothing) {
  const Pruned pruned = prune_grown(three_sessions(), 3);
  EXPECT_FALSE(prune(pruned.map, {3}).has_value());
}

TEST(Prune, ClosuresThatWereSwitchedOffAreNotSwitchedOn) {
  Map map = three_sessions();
  for (SwitchableEdge& edge : map.graph.switchable_edges) edge.switch_value = edge.id % 2 == 0 ? 0.0 : 1.0;
  std::size_t on = 0, on_after = 0;
  for (const SwitchableEdge& edge : map.graph.switchable_edges) on += edge.is_on() ? 1 : 0;
  for (const SwitchableEdge& edge : prune_grown(map, 3).map.graph.switchable_edges) on_after += edge.is_on() ? 1 : 0;
  EXPECT_GT(on_after, 0u);
  EXPECT_LE(on_after, on);
}

TEST(Prune, HappensWhenAMapIsGoneOnWithThatHasGrown) {
  Parameters parameters;
  Mapper mapper(parameters, kMount);
  mapper.set_map(three_sessions());
  const std::size_t size = mapper.map().graph.nodes.size();
  mapper.begin_session({});
  const std::optional<Renumbering> nodes = mapper.take_renumbering();
  ASSERT_TRUE(nodes.has_value());
  EXPECT_EQ(nodes->carrier.size(), size);
  EXPECT_LT(mapper.map().graph.nodes.size(), size - 99);
  const std::vector<Pose2> truth = laps(1.0);
  drive(mapper, make_room(), truth, odometry_of(truth, 0.01, 0.01, 9));
  mapper.finish();
  EXPECT_EQ(find_defect(mapper.map()), std::nullopt);
}

/// A map of two drives through a room, the second one tied to the first by closures.
struct TwoDrives {
  Map map;
  TrajectorySegments segments;
  std::uint64_t second = 0;
};

TwoDrives two_drives(const World& first, const World& second, bool tied = true) {
  TwoDrives drives;
  std::vector<Pose2> places;
  const std::vector<Pose2> truth = laps(1.0);
  for (std::size_t k = 0; k < truth.size(); k += 5) places.push_back(truth[k]);
  append_chain(first, places, {}, drives.map, drives.segments);
  drives.second = drives.map.graph.nodes.size();
  append_chain(second, places, {}, drives.map, drives.segments);
  if (tied) drives.map.graph.switchable_edges.push_back({0, drives.second, 0, {}, 1.0, 1.0});
  return drives;
}

/// 0.5 m by 0.3 m in the lower right of the room.
World with_box() {
  World world = make_room();
  add_outline({{1.9, 1.5}, {2.4, 1.5}, {2.4, 1.8}, {1.9, 1.8}}, world);
  return world;
}

std::size_t returns_on_box(const TwoDrives& drives) {
  std::size_t count = 0;
  for (std::uint64_t node = 0; node < drives.second; ++node) {
    for (const Point2& point : drives.map.clouds[node].points) {
      const Eigen::Vector2d p = drives.map.graph.nodes[node].pose * Eigen::Vector2d(point.x, point.y);
      const bool is_on_it = p.x() > 1.85 && p.x() < 2.45 && p.y() > 1.45 && p.y() < 1.85;
      count += point.is_return() && is_on_it ? 1 : 0;
    }
  }
  return count;
}

TEST(Outdated, WhatWasMovedAwayGoesAndTheRestStays) {
  TwoDrives drives = two_drives(with_box(), make_room());
  const std::size_t before = returns_on_box(drives);
  ASSERT_GT(before, 20u);
  const std::size_t removed = remove_outdated(drives.map, drives.segments, drives.second);
  EXPECT_LT(returns_on_box(drives), before / 10);
  EXPECT_LE(removed, before + 5);
}

TEST(Outdated, BeamsThroughWhatStandsThereNowGo) {
  TwoDrives drives = two_drives(make_room(), with_box());
  EXPECT_GT(remove_outdated(drives.map, drives.segments, drives.second), 20u);
}

TEST(Outdated, AHomeThatStayedAsItWasLosesNothing) {
  TwoDrives drives = two_drives(with_box(), with_box());
  EXPECT_EQ(remove_outdated(drives.map, drives.segments, drives.second), 0u);
}

TEST(Outdated, WhatNoClosureTiesHasNoSay) {
  TwoDrives drives = two_drives(with_box(), make_room(), false);
  EXPECT_EQ(remove_outdated(drives.map, drives.segments, drives.second), 0u);
}

TEST(Outdated, AFirstSessionHasNothingOlder) {
  TwoDrives drives = two_drives(with_box(), make_room());
  EXPECT_EQ(remove_outdated(drives.map, drives.segments, 0), 0u);
}

TEST(FrozenMap, KeepsTheNodesThatWereThere) {
  Parameters parameters;
  parameters.frozen_map = true;
  Mapper mapper(parameters, kMount);
  const Map before = map_of_sessions(1);
  mapper.set_map(before);
  mapper.begin_session({});
  const std::vector<Pose2> truth = laps(1.5);
  drive(mapper, make_room(), truth, odometry_of(truth, 0.02, 0.02, 7));
  mapper.finish();
  ASSERT_GT(mapper.map().graph.nodes.size(), before.graph.nodes.size());
  EXPECT_GT(mapper.map().graph.switchable_edges.size(), before.graph.switchable_edges.size());
  for (const Node& node : before.graph.nodes) {
    EXPECT_EQ(mapper.map().graph.nodes[node.id].pose.x, node.pose.x);
    EXPECT_EQ(mapper.map().graph.nodes[node.id].pose.theta, node.pose.theta);
  }
}

}  // namespace
}  // namespace oort
