// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// What decides when global SLAM takes effect: counted work, never who is faster.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "mapping_fixtures.hpp"
#include "oort/mapper/mapper.hpp"

namespace oort {
namespace {

using testing::kMount;
using testing::laps;
using testing::make_room;
using testing::odometry_of;
using testing::see;

constexpr double kDrift = 0.03;  // [rad/m]: loops close with a innovation

Parameters with_thread(bool threaded) {
  Parameters parameters = default_parameters();
  set_parameter(parameters, "global_slam_thread", threaded);
  return parameters;
}

/// Uses up a core for as long as it lives.
class Hog {
 public:
  ~Hog() {
    ending_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> ending_{false};
  std::thread thread_{[this] {
    while (!ending_) {
    }
  }};
};

/// What can be seen of a drive from outside, scan by scan: poses, corrections, closures.
struct Log {
  std::vector<Pose2> T_map_base;
  std::vector<bool> corrected;
  std::vector<std::size_t> closures;
};

Log drive_and_log(Mapper& mapper, int pause_every = 0) {
  const auto world = make_room();
  const std::vector<Pose2> truth = laps(1.3);
  const std::vector<Pose2> odometry = odometry_of(truth, 0.02, kDrift);
  Log log;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const ScanResult result =
        mapper.add_scan(see(world, truth[k] * kMount, 100.0 + 0.1 * static_cast<double>(k)), odometry[k]);
    log.T_map_base.push_back(result.T_map_base);
    log.corrected.push_back(result.corrected);
    log.closures.push_back(mapper.map().graph.switchable_edges.size());
    if (pause_every > 0 && k % static_cast<std::size_t>(pause_every) == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
  }
  return log;
}

void expect_same(const Log& a, const Log& b) {
  ASSERT_EQ(a.T_map_base.size(), b.T_map_base.size());
  for (std::size_t k = 0; k < a.T_map_base.size(); ++k) {
    ASSERT_EQ(a.T_map_base[k].x, b.T_map_base[k].x) << "scan " << k;
    ASSERT_EQ(a.T_map_base[k].theta, b.T_map_base[k].theta) << "scan " << k;
    ASSERT_EQ(a.corrected[k], b.corrected[k]) << "scan " << k;
    ASSERT_EQ(a.closures[k], b.closures[k]) << "scan " << k;
  }
}

TEST(GlobalLane, TakesEffectAtTheSameScansHoweverFastEitherLaneIs) {
  Mapper plain(with_thread(false), kMount);
  const Log expected = drive_and_log(plain);
  ASSERT_GT(expected.closures.back(), 5u);
  {
    Mapper threaded(with_thread(true), kMount);
    expect_same(drive_and_log(threaded), expected);
  }
  {
    Mapper slow(with_thread(true), kMount);
    expect_same(drive_and_log(slow, 7), expected);
  }
  const Hog hog, other_hog, third_hog;
  Mapper hindered(with_thread(true), kMount);
  expect_same(drive_and_log(hindered), expected);
}

TEST(GlobalLane, CallsBetweenScansSeeTheSameMapWithTheThreadAndWithout) {
  std::vector<Pose2> poses[2];
  for (const bool threaded : {false, true}) {
    Mapper mapper(with_thread(threaded), kMount);
    drive_and_log(mapper);
    mapper.request_dock_closure();
    drive_and_log(mapper);
    mapper.notify_docked();
    mapper.resume_from_paused();
    drive_and_log(mapper);
    mapper.finish();
    for (const Node& node : mapper.map().graph.nodes) poses[threaded ? 1 : 0].push_back(node.pose);
  }
  ASSERT_EQ(poses[0].size(), poses[1].size());
  for (std::size_t k = 0; k < poses[0].size(); ++k) {
    EXPECT_EQ(poses[0][k].x, poses[1][k].x);
    EXPECT_EQ(poses[0][k].theta, poses[1][k].theta);
  }
}

TEST(GlobalLane, EndsInTheMiddleOfItsWork) {
  for (int k = 0; k < 6; ++k) {
    Mapper mapper(with_thread(true), kMount);
    const auto world = make_room();
    const std::vector<Pose2> truth = laps(1.15);
    for (std::size_t scan = 0; scan < truth.size() - static_cast<std::size_t>(7 * k); ++scan) {
      mapper.add_scan(see(world, truth[scan] * kMount, 100.0 + 0.1 * static_cast<double>(scan)), truth[scan]);
    }
  }
}

/// A map of one segment and a lane that looks for its loops.
class Corrections : public ::testing::Test {
 protected:
  NodeAddition node(double x) const {
    NodeAddition addition;
    PointCloud cloud;
    cloud.id = next_;
    addition.cloud = std::make_shared<const PointCloud>(cloud);
    addition.begins_segment = next_ == 0;
    if (next_ > 0) addition.from = next_ - 1;
    addition.T_from_node = {x, 0.0, 0.0};
    addition.result.id = next_++;
    return addition;
  }
  mutable std::uint64_t next_ = 0;
};

TEST_F(Corrections, ASolutionCarriesTheNodesThatItDoesNotKnowWithIt) {
  GrowingMap map;
  for (int k = 0; k < 3; ++k) map.add(node(1.0));
  Solution solution = map.solution();
  solution.poses[2] = {5.0, 7.0, M_PI / 2};
  map.add(node(1.0));
  map.add(node(2.0));
  map.apply(solution);
  EXPECT_NEAR(map.map().graph.nodes[3].pose.y, 8.0, 1e-12);
  EXPECT_NEAR(map.map().graph.nodes[4].pose.y, 10.0, 1e-12);
  EXPECT_NEAR(map.map().graph.nodes[4].pose.x, 5.0, 1e-12);
}

TEST_F(Corrections, TwoMapsOfTheSameAdditionsAreTheSame) {
  GrowingMap a, b;
  for (int k = 0; k < 5; ++k) {
    const NodeAddition addition = node(0.3);
    a.add(addition);
    b.add(addition);
  }
  EXPECT_EQ(&a.map().clouds[2], &b.map().clouds[2]) << "clouds are shared";
  EXPECT_EQ(a.map().graph.nodes[4].pose.x, b.map().graph.nodes[4].pose.x);
}

TEST(SolveSchedule, SolvesWhatSurprisesAtOnceAndTheRestWithGrowth) {
  SolveSchedule schedule;
  schedule.solved_all(100);
  EXPECT_EQ(schedule.due(100, 100), SolveSchedule::Extent::kNothing);
  schedule.add_closure(1.0);
  EXPECT_EQ(schedule.due(105, 105), SolveSchedule::Extent::kNothing);
  EXPECT_EQ(schedule.due(110, 110), SolveSchedule::Extent::kAll);
  schedule.add_closure(100.0);
  EXPECT_EQ(schedule.due(105, 105), SolveSchedule::Extent::kAll);
  EXPECT_EQ(schedule.due(5000, 105), SolveSchedule::Extent::kNewest);
  schedule.solved_newest();
  EXPECT_EQ(schedule.due(5000, 105), SolveSchedule::Extent::kNothing);
}

}  // namespace
}  // namespace oort
