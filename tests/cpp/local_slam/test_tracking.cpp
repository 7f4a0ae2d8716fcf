// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// How well the place is known (docs/tracking.md), and what is done when odometry and scans contradict each other.
#include <gtest/gtest.h>

#include <vector>

#include "mapping_fixtures.hpp"
#include "oort/local_slam/tracking_state.hpp"
#include "oort/maintenance/tied_segments.hpp"

namespace oort {
namespace {

using testing::kMount;
using State = TrackingState;

struct Tie {
  std::uint64_t i, j;
  double switch_value;
};

/// Of 30 nodes in three segments: the first node of the part that closures hold together with the last one.
std::uint64_t part_begin(const std::vector<Tie>& ties) {
  Graph graph;
  TrajectorySegments segments;
  for (std::uint64_t node = 0; node < 30; ++node) {
    graph.nodes.push_back({node, {}});
    segments.add(node % 10 == 0, true, {});
  }
  for (const Tie& tie : ties) graph.switchable_edges.push_back({0, tie.i, tie.j, {}, tie.switch_value});
  return closed_parts(graph, segments).back();
}

TEST(TrackingMonitorTest, MissedScansAreUncertainAndManyAreLost) {
  TrackingMonitor monitor;
  EXPECT_EQ(monitor.update(false), State::kTracking);
  for (int k = 0; k < 19; ++k) EXPECT_EQ(monitor.update(true), State::kUncertain);
  EXPECT_EQ(monitor.update(true), State::kLost);
  EXPECT_EQ(monitor.update(false), State::kTracking);
  EXPECT_EQ(monitor.update(true), State::kUncertain);
}

TEST(TrackingMonitorTest, AnUntiedSegmentIsUncertainUntilAClosureThatIsOnTiesIt) {
  TrackingMonitor monitor;
  monitor.add_untied(20, false);
  EXPECT_EQ(monitor.update(false), State::kUncertain);
  for (const Tie& tie : {Tie{22, 20, 1.0}, Tie{18, 3, 1.0}, Tie{22, 3, 0.4}}) {
    monitor.look_for_tie(part_begin({tie}));  // within itself; elsewhere; switched off
    EXPECT_EQ(monitor.update(false), State::kUncertain);
  }
  monitor.look_for_tie(part_begin({{22, 3, 0.9}}));
  EXPECT_EQ(monitor.update(false), State::kTracking);
}

TEST(TrackingMonitorTest, AnUntiedSegmentAfterAnotherMustBeTiedToWhatWasBeforeBoth) {
  TrackingMonitor monitor;
  monitor.add_untied(10, true);
  monitor.add_untied(20, false);
  EXPECT_EQ(monitor.update(false), State::kLost);  // a guess upon a guess
  monitor.look_for_tie(part_begin({{25, 12, 1.0}}));
  EXPECT_EQ(monitor.update(false), State::kLost);
  monitor.look_for_tie(part_begin({{25, 12, 1.0}, {3, 11, 1.0}}));  // by way of the other
  EXPECT_EQ(monitor.update(false), State::kTracking);
}

TEST(TrackingMonitorTest, WhatNothingSpeaksAgainstIsBelieved) {
  TrackingMonitor monitor;
  monitor.add_untied(10, true);
  EXPECT_EQ(monitor.update(false), State::kLost);
  monitor.trust(true);
  EXPECT_EQ(monitor.update(false), State::kTracking);
  monitor.add_untied(20, false);
  EXPECT_EQ(monitor.update(false), State::kUncertain) << "what is believed is no guess any more";
}

/// Laps through the room, by odometry that fails from one scan on.
class FaultTest : public ::testing::Test {
 protected:
  FaultTest() : odometry(truth) {}

  /// The states told after each scan.
  std::vector<State> drive() {
    std::vector<State> states;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const LaserScan scan = see(world, truth[k] * kMount, 0.1 * static_cast<double>(k));
      const ScanResult result = mapper.add_scan(scan, odometry[k]);
      states.push_back(result.tracking);
      told.push_back(mapper.sensor_pose());
    }
    mapper.finish();
    return states;
  }

  /// How far off the pose that was told after a scan is, seen from the first.
  double error_at(std::size_t k) const {
    const Pose2 expected = between(truth.front() * kMount, truth[k] * kMount);
    return between(expected, between(told.front(), told[k])).translation().norm();
  }
  double error_at_end() const { return error_at(truth.size() - 1); }

  const testing::World world = testing::make_room();
  std::vector<Pose2> truth = testing::laps(1.6);
  std::vector<Pose2> odometry;
  std::vector<Pose2> told;
  Mapper mapper{Parameters(), kMount};
};

TEST_F(FaultTest, AGoodDriveIsTrackedFromItsFirstScan) {
  const std::vector<State> states = drive();
  EXPECT_EQ(std::count(states.begin(), states.end(), State::kTracking), static_cast<long>(states.size()));
  EXPECT_EQ(mapper.statistics().trajectory.contradictions, 0u);
  EXPECT_EQ(mapper.statistics().tracking.tracking, states.size());
  EXPECT_EQ(mapper.statistics().tracking.changes, 0u);
}

TEST_F(FaultTest, OdometryThatJumpsIsOverruledAndAClosureTellsThatItWasRight) {
  constexpr std::size_t kJump = 250;
  for (std::size_t k = kJump; k < odometry.size(); ++k) odometry[k] = Pose2{0.5, -0.4, 0.3} * odometry[k];
  const std::vector<State> states = drive();
  EXPECT_LT(error_at_end(), 0.1);
  EXPECT_EQ(states.back(), State::kTracking);
  EXPECT_EQ(std::count(states.begin(), states.begin() + kJump, State::kTracking), static_cast<long>(kJump));
}

/// Its wheels stand still for two seconds while somebody carries it on along its way.
TEST_F(FaultTest, ARobotThatIsCarriedWhileItLooksIsFollowed) {
  constexpr std::size_t kLifted = 250, kPutDown = 270;
  for (std::size_t k = kLifted; k < truth.size(); ++k) {
    odometry[k] = k < kPutDown ? odometry[k - 1] : odometry[k - 1] * between(truth[k - 1], truth[k]);
  }
  const std::vector<State> states = drive();
  for (std::size_t k = 0; k < truth.size(); ++k) EXPECT_LT(error_at(k), 0.1) << "scan " << k;
  EXPECT_EQ(std::count(states.begin(), states.end(), State::kTracking), static_cast<long>(states.size()));
  ASSERT_GE(mapper.statistics().odometry_fault_count, 1u);
  EXPECT_EQ(mapper.statistics().odometry_faults.front().kind, OdometryFault::Kind::kFreeze);
}

/// Odometry freezes for two seconds and then makes up for them at once.
TEST_F(FaultTest, OdometryThatFreezesAndCatchesUpIsSeenThrough) {
  constexpr std::size_t kFrozen = 250, kAwake = 270;
  for (std::size_t k = kFrozen; k < kAwake; ++k) odometry[k] = odometry[kFrozen - 1];
  const std::vector<State> states = drive();
  for (std::size_t k = 0; k < truth.size(); ++k) EXPECT_LT(error_at(k), 0.1) << "scan " << k;
  EXPECT_EQ(std::count(states.begin(), states.end(), State::kTracking), static_cast<long>(states.size()));
  EXPECT_EQ(mapper.statistics().trajectory.contradictions, 0u);
}

/// Odometry begins anew at zero, metres away from where it was.
TEST_F(FaultTest, OdometryThatRestartsAtZeroIsSeenThrough) {
  constexpr std::size_t kRestart = 250;
  const Pose2 restart = truth[kRestart];
  for (std::size_t k = kRestart; k < odometry.size(); ++k) odometry[k] = between(restart, truth[k]);
  const std::vector<State> states = drive();
  for (std::size_t k = 0; k < truth.size(); ++k) EXPECT_LT(error_at(k), 0.1) << "scan " << k;
  EXPECT_EQ(states.back(), State::kTracking);
  EXPECT_EQ(mapper.statistics().trajectory.contradictions, 0u);
  ASSERT_EQ(mapper.statistics().odometry_fault_count, 1u);
  EXPECT_EQ(mapper.statistics().odometry_faults.front().kind, OdometryFault::Kind::kJump);
  EXPECT_NEAR(mapper.statistics().odometry_faults.front().time, 25.0, 1e-9);
}

/// It sees nothing of how it comes to a place three metres farther on.
TEST_F(FaultTest, ARobotThatIsPutDownElsewhereIsNotToldToBeTrackedForLong) {
  constexpr std::size_t kLifted = 250, kPutDown = 330;
  truth.erase(truth.begin() + kLifted, truth.begin() + kPutDown);
  odometry.assign(truth.begin(), truth.begin() + kLifted);
  while (odometry.size() < truth.size()) {
    const std::size_t k = odometry.size();
    odometry.push_back(k == kLifted ? odometry.back() : odometry.back() * between(truth[k - 1], truth[k]));
  }
  const std::vector<State> states = drive();
  std::size_t told_wrongly = 0;
  for (std::size_t k = kLifted; k < truth.size(); ++k) {
    told_wrongly += error_at(k) > 0.3 && states[k] == State::kTracking ? 1 : 0;
  }
  EXPECT_LE(told_wrongly, 10u);  // a second
  EXPECT_GE(mapper.statistics().tracking.changes, 1u);
}

TEST_F(FaultTest, TheLinkOfAContradictionIsWideAndBeginsASegmentWhereverItIsRead) {
  constexpr std::size_t kSlip = 250, kSteps = 6;  // one wheel slips: odometry turns, the robot does not
  const Pose2 before = odometry[kSlip - 1];
  for (std::size_t k = kSlip; k < odometry.size(); ++k) {
    const double turned = 0.9 * static_cast<double>(std::min(k - kSlip + 1, kSteps)) / kSteps;
    odometry[k] = before * Pose2{0.0, 0.0, turned} * between(before, odometry[k]);
  }
  drive();
  ASSERT_GE(mapper.statistics().trajectory.contradictions, 1u);
  const Map& map = mapper.map();
  const TrajectorySegments segments = TrajectorySegments::of_map(map);
  const auto is_wide = [](const Edge& edge) { return edge.constraint.covariance(0, 0) > 0.25; };
  ASSERT_EQ(std::count_if(map.graph.edges.begin(), map.graph.edges.end(), is_wide),
            static_cast<long>(mapper.statistics().trajectory.contradictions));
  const auto wide = std::find_if(map.graph.edges.begin(), map.graph.edges.end(), is_wide);
  EXPECT_EQ(wide->i + 1, wide->j);
  EXPECT_EQ(segments.segment_begin(wide->j), wide->j);
  EXPECT_FALSE(segments.same_segment(wide->i, wide->j));
}

}  // namespace
}  // namespace oort
