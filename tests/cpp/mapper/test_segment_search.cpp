// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// A robot whose place is not known any more finds home (docs/tracking.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mapping_fixtures.hpp"
#include "oort/map/parts.hpp"
#include "oort/mapper/mapper.hpp"
#include "oort/mapper/segment_search.hpp"

namespace oort {
namespace {

using namespace testing;

/// Two laps of a room, then `carry`, then another lap that begins half way round while odometry goes on as if nothing
/// had happened.
class CarriedRobot {
 public:
  template <class Carry>
  explicit CarriedRobot(const Carry& carry, bool threaded = true) : mapper_(parameters(threaded), kMount) {
    const std::size_t lap = whole_.size() / 3;
    before_ = {whole_.begin(), whole_.begin() + static_cast<std::ptrdiff_t>(2 * lap)};
    drive(mapper_, world_, before_, odometry_of(before_, 0.01, 0.01));
    carry(mapper_);
    after_ = {whole_.begin() + static_cast<std::ptrdiff_t>(lap + lap / 2), whole_.end()};
  }

  /// So far of the other lap.
  void drive_on(double metres) {
    after_.resize(static_cast<std::size_t>(metres / 0.04));
    drive(mapper_, world_, after_, odometry_of(after_, 0.01, 0.01, 2), 1000.0);
  }

  /// The larger of metres and radians.
  double error() const {
    const Pose2 T_world_map = before_.front() * kMount;
    const Pose2 error = between(after_.back() * kMount, T_world_map * mapper_.sensor_pose());
    return std::max(error.translation().norm(), std::abs(error.theta));
  }

  Mapper& mapper() { return mapper_; }

 private:
  static Parameters parameters(bool threaded) {
    Parameters parameters = documented_parameters();
    parameters.global_slam_thread = threaded;
    return parameters;
  }

  const World world_ = make_room();
  const std::vector<Pose2> whole_ = laps(3.0);
  std::vector<Pose2> before_, after_;
  Mapper mapper_;
};

void pause(Mapper& mapper) {
  mapper.resume_from_paused();
}

TEST(SegmentSearchTest, ARobotCarriedWhilePausedIsHomeWithinMetres) {
  CarriedRobot robot(pause);
  robot.drive_on(6.0);
  EXPECT_LT(robot.error(), 0.1);
  EXPECT_TRUE(parts_of(robot.mapper().map()).loose.empty());
}

TEST(SegmentSearchTest, ASessionAtAWrongPoseIsHomeWithinMetres) {
  CarriedRobot robot([](Mapper& mapper) { mapper.begin_session({4.0, -3.0, 3.0}); });
  robot.drive_on(6.0);
  EXPECT_LT(robot.error(), 0.1);
}

TEST(SegmentSearchTest, FindsTheSamePlaceWithoutTheThread) {
  CarriedRobot with(pause, true), without(pause, false);
  with.drive_on(6.0);
  without.drive_on(6.0);
  EXPECT_EQ(with.error(), without.error());
}

TEST(SegmentSearchTest, AtTheEndWhatNoClosureTiesIsLookedForAtAllHeadings) {
  CarriedRobot robot(pause);
  robot.drive_on(6.0);
  Map map = robot.mapper().map();
  const Pose2 home = map.graph.nodes.back().pose;
  const TrajectorySegments segments = TrajectorySegments::of_map(map);
  const std::uint64_t begin = segments.segment_begin(map.graph.nodes.size() - 1);
  ASSERT_GT(begin, 0u);
  map.graph.switchable_edges.clear();
  for (Node& node : map.graph.nodes) {
    if (node.id >= begin) node.pose = Pose2{3.0, -2.0, 2.0} * node.pose;
  }
  SegmentSearch search{documented_parameters()};
  WorkBudget budget(1e7), nothing(0.0);
  const std::vector<SegmentFinding> findings = search.look_for_all(map, segments, budget);
  const auto found = std::find_if(findings.begin(), findings.end(), [begin](const SegmentFinding& finding) {
    return finding.nodes.front().begin == begin;  // the laps have segments of their own, that nothing ties now
  });
  ASSERT_NE(found, findings.end());
  EXPECT_TRUE(found->disproved);
  EXPECT_GE(found->closures.size(), 3u);
  const Pose2 off = between(home, found->T_new_old * map.graph.nodes.back().pose);
  EXPECT_LT(off.translation().norm(), 0.1);
  EXPECT_LT(std::abs(off.theta), 0.05);
  EXPECT_TRUE(search.look_for_all(map, segments, nothing).empty()) << "it may look no more";
}

/// The closures that are found for the third lap of a room, which a doubted edge of the odometry has so far [m] off.
std::size_t closures_of_a_robot_off_by(double metres) {
  const World world = make_room();
  const std::vector<Pose2> way = laps(3.0);
  const std::size_t step = 5, lost = way.size() / step * 2 / 3;
  Map map;
  TrajectorySegments segments;
  SegmentSearch search{Parameters()};
  std::size_t found = 0;
  for (std::uint64_t id = 0; id * step < way.size(); ++id) {
    const Pose2& place = way[id * step];
    PointCloud cloud = to_point_cloud(see(world, place, static_cast<double>(id), kAllRound));
    cloud.id = id;
    map.clouds.push_back(std::move(cloud));
    map.graph.nodes.push_back({id, id < lost ? place : Pose2{metres, 0.0, 0.0} * place});
    segments.add(id == 0 || id == lost, true, place);
    if (id > 0) {
      Edge edge;
      edge.i = id - 1;
      edge.j = id;
      edge.constraint.T_i_j = between(map.graph.nodes[id - 1].pose, map.graph.nodes[id].pose);
      const double sigma = id == lost ? 0.26 : 0.01;
      edge.constraint.covariance = Eigen::Matrix3d::Identity() * sigma * sigma;
      map.graph.edges.push_back(edge);
    }
    if (id == lost) search.begin(id, Doubt::kOdometry);
    if (search.is_due(map.graph.nodes.size())) found += search.look(map, segments, nullptr).closures.size();
  }
  return found;
}

TEST(SegmentSearchTest, ARobotThatSlippedByMetresIsFound) {
  EXPECT_GE(closures_of_a_robot_off_by(15.0), 3u);
}

/// Three answers that agree may all be wrong: on open ground one row of boxes looks like the next.
TEST(SegmentSearchTest, NobodyCarriesARobotAHundredMetresFromOneScanToTheNext) {
  EXPECT_EQ(closures_of_a_robot_off_by(100.0), 0u);
}

TEST(SegmentSearchTest, LooksForNothingOnAnEmptyMap) {
  SegmentSearch search{Parameters()};
  EXPECT_FALSE(search.is_due(0));
  WorkBudget budget(1e7);
  EXPECT_TRUE(search.look_for_all(Map{}, TrajectorySegments(), budget).empty());
}

}  // namespace
}  // namespace oort
