// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// The mapper on drives through a made-up room.
#include <gtest/gtest.h>

#include <set>

#include "mapping_fixtures.hpp"
#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

using testing::drive;
using testing::kMount;
using testing::laps;
using testing::make_room;
using testing::odometry_of;
using testing::see;
using testing::World;

struct Errors {
  double position = 0.0;  ///< largest [m]
  double heading = 0.0;   ///< largest [rad]
};

/// Of the nodes against the truth, in the map's frame: that of the first sensor pose. A node is found by its time.
Errors node_errors(const Map& map, const std::vector<Pose2>& truth, double start = 100.0) {
  Errors errors;
  for (const Node& node : map.graph.nodes) {
    const auto k = static_cast<std::size_t>(std::lround((map.clouds[node.id].time - start) / 0.1));
    const Pose2 expected = between(truth.at(0) * kMount, truth.at(k) * kMount);
    const Pose2 error = between(expected, node.pose);
    errors.position = std::max(errors.position, error.translation().norm());
    errors.heading = std::max(errors.heading, std::abs(error.theta));
  }
  return errors;
}

void expect_same(const Map& a, const Map& b) {
  ASSERT_EQ(a.graph.nodes.size(), b.graph.nodes.size());
  ASSERT_EQ(a.graph.edges.size(), b.graph.edges.size());
  ASSERT_EQ(a.graph.switchable_edges.size(), b.graph.switchable_edges.size());
  const auto expect_same_pose = [](const Pose2& p, const Pose2& q) {
    EXPECT_EQ(p.x, q.x);
    EXPECT_EQ(p.y, q.y);
    EXPECT_EQ(p.theta, q.theta);
  };
  for (std::size_t k = 0; k < a.graph.nodes.size(); ++k) {
    expect_same_pose(a.graph.nodes[k].pose, b.graph.nodes[k].pose);
    EXPECT_EQ(a.clouds[k].time, b.clouds[k].time);
  }
  for (std::size_t k = 0; k < a.graph.edges.size(); ++k) {
    expect_same_pose(a.graph.edges[k].constraint.T_i_j, b.graph.edges[k].constraint.T_i_j);
    EXPECT_EQ(a.graph.edges[k].constraint.covariance, b.graph.edges[k].constraint.covariance);
  }
  for (std::size_t k = 0; k < a.graph.switchable_edges.size(); ++k) {
    EXPECT_EQ(a.graph.switchable_edges[k].i, b.graph.switchable_edges[k].i);
    EXPECT_EQ(a.graph.switchable_edges[k].switch_value, b.graph.switchable_edges[k].switch_value);
  }
}

class MapperTest : public ::testing::Test {
 protected:
  const World world = make_room();
  const std::vector<Pose2> truth = laps(1.3);
};

TEST_F(MapperTest, ExactOdometryGivesTheTruth) {
  for (const Parameters& parameters : {Parameters(), testing::documented_parameters()}) {
    Mapper mapper(parameters, kMount);
    drive(mapper, world, truth, truth);
    mapper.finish();
    const Errors errors = node_errors(mapper.map(), truth);
    EXPECT_LT(errors.position, 0.03);
    EXPECT_LT(errors.heading, 0.015);
    EXPECT_EQ(mapper.statistics().trajectory.odometry_edges, 0u);
    EXPECT_GT(mapper.statistics().global.loops.accepted, 0u);
  }
}

TEST_F(MapperTest, PoorOdometryIsCorrected) {
  const std::vector<Pose2> odometry = odometry_of(truth, 0.03, 0.02);
  const Pose2 drift = between(between(truth.front(), truth.back()), between(odometry.front(), odometry.back()));
  ASSERT_GT(drift.translation().norm(), 0.25);  // what the odometry says by itself
  Mapper mapper(Parameters(), kMount);
  drive(mapper, world, truth, odometry);
  mapper.finish();
  const Errors errors = node_errors(mapper.map(), truth);
  EXPECT_LT(errors.position, 0.05);
  EXPECT_LT(errors.heading, 0.02);
  for (const SwitchableEdge& edge : mapper.map().graph.switchable_edges) EXPECT_GT(edge.switch_value, 0.5);
}

TEST_F(MapperTest, SensorPoseAndOdometryFrameFollowTheDrive) {
  const std::vector<Pose2> odometry = odometry_of(truth, 0.02, 0.01);
  Mapper mapper(Parameters(), kMount);
  EXPECT_FALSE(mapper.has_pose());
  EXPECT_THROW(mapper.sensor_pose(), StateError);
  EXPECT_THROW(mapper.T_map_odom(), StateError);
  for (std::size_t k = 0; k < 150; ++k) {
    mapper.add_scan(see(world, truth[k] * kMount, 0.1 * static_cast<double>(k)), odometry[k]);
    ASSERT_TRUE(mapper.has_pose());
    const Pose2 expected = between(truth[0] * kMount, truth[k] * kMount);
    ASSERT_LT(between(expected, mapper.sensor_pose()).translation().norm(), 0.04) << k;
    const Pose2 again = mapper.T_map_odom() * odometry[k] * kMount;
    ASSERT_NEAR(again.x, mapper.sensor_pose().x, 1e-9);
    ASSERT_NEAR(again.y, mapper.sensor_pose().y, 1e-9);
  }
}

TEST_F(MapperTest, NodesAreMadeByTheMotionOfTheBase) {
  Mapper mapper(Parameters(), {0.5, 0.0, 0.0});  // a sensor half a metre ahead: turning moves it
  const auto turn = [&](double theta, double time) {
    const Pose2 base{-1.3, -1.05, theta};
    return mapper.add_scan(see(world, base * Pose2{0.5, 0.0, 0.0}, time), base).outcome;
  };
  EXPECT_EQ(turn(0.0, 0.0), ScanOutcome::kNode);
  EXPECT_EQ(turn(0.59, 0.1), ScanOutcome::kLocated);  // the sensor moved by 0.29 m
  EXPECT_EQ(turn(0.61, 0.2), ScanOutcome::kNode);
  const auto forward = [&](double x, double time) {
    const Pose2 base = Pose2{-1.3, -1.05, 0.61} * Pose2{x, 0.0, 0.0};
    return mapper.add_scan(see(world, base * Pose2{0.5, 0.0, 0.0}, time), base).outcome;
  };
  EXPECT_EQ(forward(0.199, 0.3), ScanOutcome::kLocated);
  EXPECT_EQ(forward(0.201, 0.4), ScanOutcome::kNode);
}

TEST_F(MapperTest, SameScansGiveTheSameMapWhateverElseRuns) {
  const std::vector<Pose2> odometry = odometry_of(truth, 0.03, 0.02);
  Mapper alone(Parameters(), kMount);
  drive(alone, world, truth, odometry);
  alone.finish();

  // Two mappers, fed in turn, the other with another drive.
  const std::vector<Pose2> other_truth(truth.rbegin(), truth.rend());
  Mapper one(Parameters(), kMount);
  Mapper other(testing::documented_parameters());
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const double time = 100.0 + 0.1 * static_cast<double>(k);
    other.add_scan(see(world, other_truth[k], time), other_truth[k]);
    one.add_scan(see(world, truth[k] * kMount, time), odometry[k]);
  }
  other.finish();
  one.finish();
  expect_same(one.map(), alone.map());
}

TEST_F(MapperTest, MapIsWellFormed) {
  Mapper mapper(Parameters(), kMount);
  drive(mapper, world, truth, odometry_of(truth, 0.03, 0.02));
  mapper.finish();
  const Map& map = mapper.map();
  const std::size_t nodes = map.graph.nodes.size();
  ASSERT_GT(nodes, 40u);
  EXPECT_EQ(map.clouds.size(), nodes);
  EXPECT_EQ(map.incremental_results.size(), nodes);
  EXPECT_EQ(map.loop_results.size(), map.graph.switchable_edges.size());
  EXPECT_EQ(map.graph.nodes[0].pose.x, 0.0);  // the first sensor pose is the origin
  EXPECT_EQ(map.graph.nodes[0].pose.theta, 0.0);
  for (std::size_t k = 0; k < nodes; ++k) {
    EXPECT_EQ(map.graph.nodes[k].id, k);
    EXPECT_EQ(map.clouds[k].id, k);
    EXPECT_EQ(map.clouds[k].points.size(), 180u);
    EXPECT_EQ(map.incremental_results[k].id, k);
    EXPECT_EQ(map.incremental_results[k].target, k == 0 ? 0 : k - 1);
  }
  std::set<std::uint64_t> ids;  // one counter serves both kinds
  for (const Edge& edge : map.graph.edges) {
    EXPECT_TRUE(ids.insert(edge.id).second);
    EXPECT_EQ(edge.i + 1, edge.j);
    EXPECT_EQ(edge.constraint.id, edge.j);
    EXPECT_EQ(edge.constraint.time, map.clouds[edge.j].time);
    EXPECT_EQ(edge.constraint.type, ConstraintType::kLaser);
  }
  ASSERT_FALSE(map.graph.switchable_edges.empty());
  for (std::size_t k = 0; k < map.graph.switchable_edges.size(); ++k) {
    const SwitchableEdge& edge = map.graph.switchable_edges[k];
    EXPECT_TRUE(ids.insert(edge.id).second);
    EXPECT_GT(edge.i, edge.j);  // from the newer node to the candidate
    EXPECT_EQ(map.loop_results[k].id, edge.i);
    EXPECT_EQ(map.loop_results[k].target, edge.j);
  }
  const MapperStatistics& statistics = mapper.statistics();
  EXPECT_EQ(statistics.trajectory.nodes, nodes);
  EXPECT_EQ(statistics.local.scans, truth.size());
  EXPECT_EQ(statistics.local.scans_too_small, 0u);
  EXPECT_EQ(statistics.global.loops.accepted, map.graph.switchable_edges.size());
}

TEST_F(MapperTest, ParkedRobotAddsNothing) {
  Mapper mapper(Parameters(), kMount);
  const std::vector<Pose2> some(truth.begin(), truth.begin() + 50);
  drive(mapper, world, some, some);
  const std::size_t nodes = mapper.map().graph.nodes.size();
  const std::uint64_t solves = mapper.statistics().global.solves;
  for (int k = 0; k < 500; ++k) {
    EXPECT_EQ(mapper.add_scan(see(world, some.back() * kMount, 200.0 + 0.1 * k), some.back()).outcome,
              ScanOutcome::kLocated);
  }
  EXPECT_EQ(mapper.map().graph.nodes.size(), nodes);
  EXPECT_EQ(mapper.statistics().global.solves, solves);
}

TEST_F(MapperTest, ScansWithFewReturnsMakeNoNode) {
  Parameters parameters;
  set_parameter(parameters, "min_pointcloud_size", std::int64_t{5});
  Mapper mapper(parameters);
  LaserScan scan{0.0, 0.0, 0.1, 0.05, 3.0, {1.0F, 1.0F, 1.0F, 1.0F, 3.0F, INFINITY, NAN}};
  EXPECT_EQ(mapper.add_scan(scan, {}).outcome, ScanOutcome::kSkipped);
  EXPECT_FALSE(mapper.has_pose());
  scan.ranges.push_back(2.0F);
  EXPECT_EQ(mapper.add_scan(scan, {}).outcome, ScanOutcome::kNode);
  scan.ranges.pop_back();
  const ScanResult far = mapper.add_scan(scan, {1.0, 0.0, 0.0});  // carried by odometry, however far
  EXPECT_EQ(far.outcome, ScanOutcome::kSkipped);
  EXPECT_EQ(far.node_id, 0u);
  EXPECT_DOUBLE_EQ(far.T_node_sensor.x, 1.0);
  EXPECT_EQ(mapper.map().graph.nodes.size(), 1u);
  EXPECT_EQ(mapper.statistics().local.scans_too_small, 2u);
}

TEST_F(MapperTest, RefusesWhatIsNotFiniteAndStaysAsItWas) {
  Mapper mapper(Parameters(), kMount);
  const std::vector<Pose2> some(truth.begin(), truth.begin() + 30);
  drive(mapper, world, some, some);
  const Map before = mapper.map();
  const std::uint64_t scans = mapper.statistics().local.scans;
  const LaserScan good = see(world, some.back() * kMount, 200.0);
  EXPECT_THROW(mapper.add_scan(good, {NAN, 0.0, 0.0}), InputError);
  EXPECT_THROW(mapper.add_scan(good, {0.0, 0.0, INFINITY}), InputError);
  LaserScan bad = good;
  bad.time = NAN;
  EXPECT_THROW(mapper.add_scan(bad, some.back()), InputError);
  bad = good;
  bad.angle_increment = INFINITY;
  EXPECT_THROW(mapper.add_scan(bad, some.back()), InputError);
  EXPECT_THROW(mapper.begin_session({0.0, NAN, 0.0}), InputError);
  EXPECT_THROW(Mapper(Parameters(), {NAN, 0.0, 0.0}), InputError);
  EXPECT_EQ(mapper.statistics().local.scans, scans);
  expect_same(mapper.map(), before);
}

TEST_F(MapperTest, RefusesParametersThatContradictEachOther) {
  Parameters parameters;
  parameters.dock_graph_builder.dock_match_submap_size = parameters.dock_graph_builder.dock_submap_size;
  EXPECT_THROW(Mapper{parameters}, ParameterError);
}

/// Odometry that jumps once, by more than the documented match_filtering lets pass; the scans are the truth's.
TEST_F(MapperTest, MatchAgainstTheOdometryBecomesAnOdometryLink) {
  std::vector<Pose2> odometry = truth;
  constexpr std::size_t kJump = 80;
  for (std::size_t k = kJump; k < odometry.size(); ++k) odometry[k] = Pose2{0.0, 0.3, 0.0} * odometry[k];
  Mapper mapper(testing::documented_parameters(), kMount);
  drive(mapper, world, truth, odometry);
  const Map& map = mapper.map();
  const MapperStatistics& statistics = mapper.statistics();
  EXPECT_GE(statistics.trajectory.odometry_edges, 1u);
  EXPECT_EQ(statistics.trajectory.match_rejections[Rejection::kNone], 0u);
  EXPECT_EQ(statistics.trajectory.match_rejections.total(), statistics.trajectory.odometry_edges);
  const auto jump = std::find_if(map.graph.edges.begin(), map.graph.edges.end(),
                                 [](const Edge& e) { return e.constraint.type == ConstraintType::kOdometry; });
  ASSERT_NE(jump, map.graph.edges.end());
  EXPECT_EQ(jump->i + 1, jump->j);
  EXPECT_NEAR(map.clouds[jump->j].time, 100.0 + 0.1 * kJump, 0.6);
  // What the odometry link says is what the odometry says.
  const auto at = [&](std::uint64_t node) {
    return odometry[static_cast<std::size_t>(std::lround((map.clouds[node].time - 100.0) / 0.1))] * kMount;
  };
  const Pose2 expected = between(at(jump->i), at(jump->j));
  EXPECT_NEAR(jump->constraint.T_i_j.x, expected.x, 1e-9);
  EXPECT_NEAR(jump->constraint.T_i_j.y, expected.y, 1e-9);
}

TEST_F(MapperTest, ASessionOnTheMapInMemoryIsThatOnTheMapLoaded) {
  const std::vector<Pose2> odometry = testing::odometry_of(truth, 0.03, 0.02);
  Mapper mapper(Parameters(), kMount);
  drive(mapper, world, truth, odometry);
  mapper.finish();
  Mapper loaded(Parameters(), kMount);
  loaded.set_map(mapper.map());
  for (Mapper* session : {&mapper, &loaded}) {
    session->begin_session({});
    drive(*session, world, truth, odometry, 1000.0);
    session->finish();
  }
  expect_same(mapper.map(), loaded.map());
}

}  // namespace
}  // namespace oort
