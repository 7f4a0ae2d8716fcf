// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Scans that were taken while the robot moved, odometry beyond its end, and nodes by time.
#include <gtest/gtest.h>

#include <random>

#include "mapping_fixtures.hpp"
#include "oort/geometry/errors.hpp"
#include "oort/geometry/sweep.hpp"
#include "oort/localization/localizer.hpp"
#include "oort/odometry/odometry_buffer.hpp"

namespace oort {
namespace {

using testing::kMount;
using testing::make_room;
using testing::see;
using testing::World;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void expect_near(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(wrap_angle(a.theta - b.theta), 0.0, tolerance);
}

/// A scan whose beams are measured one after the other, while the base moves along an arc by `motion`, from the pose
/// where it is at the stamp. `reversed`: the last beam is measured at the stamp, the first one at the end.
LaserScan see_sweeping(const World& world, const Pose2& T_world_base, const Pose2& motion, double time,
                       const testing::Sensor& sensor = {}, bool reversed = false) {
  LaserScan scan = see(world, T_world_base * kMount, time, sensor);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(scan.ranges.size() - 1);
    const Pose2 eye = T_world_base * along_arc(motion, reversed ? 1.0 - share : share) * kMount;
    const double bearing = eye.theta + scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    scan.ranges[i] = static_cast<float>(range_to(world, eye.translation(), bearing));
  }
  return scan;
}

TEST(Arc, PartsOfAMotionAddUp) {
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    const Pose2 motion{uniform(generator), uniform(generator), (k % 3 == 0 ? 1e-9 : 3.0) * uniform(generator)};
    expect_near(along_arc(motion, 0.0), {}, 0.0);
    expect_near(along_arc(motion, 1.0), motion, 1e-15);
    const double a = uniform(generator), b = uniform(generator);
    expect_near(along_arc(motion, a) * along_arc(motion, b), along_arc(motion, a + b), 1e-9);
    expect_near(along_arc(motion, -1.0), inverse(motion), 1e-9);
  }
  expect_near(along_arc({1.0, 1.0, M_PI / 2}, 2.0), {0.0, 2.0, M_PI}, 1e-12);  // a quarter circle, then a half one
}

TEST(Sweep, EachPointComesToWhereItIsFromTheStamp) {
  const World room = make_room();
  const Pose2 base{-0.4, -1.0, 0.7};
  for (const Pose2& motion : {Pose2{0.05, 0.0, 0.1}, Pose2{-0.02, 0.01, -0.3}, Pose2{0.04, 0.0, 0.0}}) {
    for (const bool reversed : {false, true}) {
      const LaserScan scan = see_sweeping(room, base, motion, 5.0, testing::kAllRound, reversed);
      const Sweep sweep = reversed ? Sweep{motion, {}} : Sweep{{}, motion};
      const PointCloud cloud = deskew(to_point_cloud(scan), sweep_of_sensor(sweep, kMount));
      EXPECT_EQ(cloud.time, 5.0);
      for (const Point2& p : cloud.points) {
        ASSERT_TRUE(p.is_return());
        const double range = std::hypot(p.x, p.y);
        const Pose2 eye = base * kMount;
        const double truth = range_to(room, eye.translation(), eye.theta + std::atan2(p.y, p.x));
        // Behind an edge the moved sensor sees what the standing one does not: such points are not nearer than the
        // edge.
        if (range < truth + 0.02) {
          EXPECT_NEAR(range, truth, 1e-4);
        }
      }
      const auto fits = std::count_if(cloud.points.begin(), cloud.points.end(), [&](const Point2& p) {
        const Pose2 eye = base * kMount;
        return std::abs(std::hypot(p.x, p.y) - range_to(room, eye.translation(), eye.theta + std::atan2(p.y, p.x))) <
               1e-4;
      });
      EXPECT_GT(fits, 350);
      EXPECT_EQ(static_cast<float>(cloud.points[7].x), cloud.points[7].x);
    }
  }
}

TEST(Sweep, KeepsWhatIsNoReturn) {
  const float inf = std::numeric_limits<float>::infinity();
  const LaserScan scan{1.0, 0.0, 0.5, 0.1, 3.0, {1.0F, inf, static_cast<float>(kNan), 4.0F, 1.0F}};
  const PointCloud before = to_point_cloud(scan);
  const PointCloud cloud = deskew(before, {{}, {0.0, 0.0, 0.4}});
  EXPECT_EQ(cloud.points[1].x, inf);
  EXPECT_NEAR(cloud.points[1].y, 0.5 + 0.1, 1e-12);  // the bearing turned by a quarter of the turn
  EXPECT_TRUE(std::isnan(cloud.points[2].x));
  EXPECT_FALSE(cloud.points[3].is_return());
  EXPECT_NEAR(std::hypot(cloud.points[3].x, cloud.points[3].y), 4.0, 1e-6);
  EXPECT_EQ(count_returns(cloud), count_returns(before));
}

TEST(Sweep, WithoutMotionOrWithAnImpossibleOneNothingChanges) {
  const PointCloud cloud = to_point_cloud(see(make_room(), {}, 0.0));
  for (const Sweep& sweep : {Sweep{}, Sweep{{}, {1.5, 0.0, 0.0}}, Sweep{{0.0, 0.0, -0.6}, {0.0, 0.0, 0.6}},
                             Sweep{{5.0, 0.0, 0.0}, {5.0, 0.0, 0.0}}}) {
    const PointCloud same = deskew(cloud, sweep);
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      EXPECT_EQ(same.points[i].x, cloud.points[i].x);
      EXPECT_EQ(same.points[i].y, cloud.points[i].y);
    }
  }
  EXPECT_THROW(deskew(cloud, {{}, {kNan, 0.0, 0.0}}), InputError);
}

/// Laps with scans that sweep: the largest error of a node.
double worst_node(bool compensated) {
  const World room = make_room();
  const std::vector<Pose2> truth = testing::laps(1.0);
  Parameters parameters;
  parameters.motion_compensation = compensated;
  Mapper mapper(parameters, kMount);
  for (std::size_t k = 0; k + 1 < truth.size(); ++k) {
    const Pose2 motion = between(truth[k], truth[k + 1]);
    mapper.add_scan(see_sweeping(room, truth[k], motion, 0.1 * static_cast<double>(k)), truth[k], {{}, motion});
  }
  mapper.finish();
  double worst = 0.0;
  for (const Node& node : mapper.map().graph.nodes) {
    const auto k = static_cast<std::size_t>(std::lround(mapper.map().clouds[node.id].time / 0.1));
    worst = std::max(worst, std::abs(between(between(truth[0] * kMount, truth[k] * kMount), node.pose).theta));
  }
  return worst;
}

TEST(Mapper, CompensatesTheMotionWithinAScan) {
  EXPECT_LT(worst_node(true), 0.01);
  EXPECT_GT(worst_node(false), 2.0 * worst_node(true));
}

TEST(Mapper, RefusesAMotionThatIsNotFinite) {
  Mapper mapper(Parameters(), kMount);
  EXPECT_THROW(mapper.add_scan(see(make_room(), kMount, 0.0), {}, {{}, {0.0, kNan, 0.0}}), InputError);
  EXPECT_EQ(mapper.statistics().local.scans, 0U);
}

TEST(Mapper, AParkedRobotAddsNodesByTimeIfAsked) {
  for (const double time_update : {0.0, 5.0}) {
    Parameters parameters;
    parameters.time_update = time_update;
    Mapper mapper(parameters, kMount);
    for (int k = 0; k <= 300; ++k) mapper.add_scan(see(make_room(), kMount, 0.1 * k), {});
    EXPECT_EQ(mapper.map().graph.nodes.size(), time_update > 0.0 ? 7U : 1U);  // at 0, 5, ... 30 s
    const double last = mapper.map().clouds.back().time;
    mapper.add_scan(see(make_room(), kMount, last - 100.0), {});  // a clock that was set back
    mapper.add_scan(see(make_room(), kMount, last - 99.9), {});
    EXPECT_EQ(mapper.map().graph.nodes.size(), time_update > 0.0 ? 8U : 1U);
  }
}

TEST(Localizer, CompensatesTheMotionWithinAScan) {
  const World room = make_room();
  Mapper mapper(Parameters(), kMount);
  const std::vector<Pose2> truth = testing::laps(1.0);
  testing::drive(mapper, room, truth, truth);
  mapper.finish();
  const auto map = std::make_shared<ReferenceMap>(mapper.map(), Parameters());
  const Pose2 motion{0.0, 0.0, 0.15};
  const Pose2 T_map_sensor = between(truth[0] * kMount, truth[40] * kMount);
  const auto heading_error = [&](bool compensates) {
    Parameters parameters;
    parameters.motion_compensation = compensates;
    Localizer localizer(map, parameters, kMount);
    localizer.start_at(T_map_sensor, 0.01 * Eigen::Matrix3d::Identity());
    localizer.add_scan(see_sweeping(room, truth[40], motion, 0.0), {}, {{}, motion});
    return std::abs(wrap_angle(localizer.T_map_sensor()->theta - T_map_sensor.theta));
  };
  EXPECT_LT(heading_error(true), 0.015);
  EXPECT_GT(heading_error(false), 0.04);
}

TEST(OdometryBuffer, GoesOnForAWhileWhereNothingComes) {
  const Pose2 speed{0.4, 0.0, 1.0};  // the motion of a second
  OdometryBuffer buffer;
  for (int k = 0; k <= 50; ++k) buffer.add(0.02 * k, along_arc(speed, 0.02 * k));
  EXPECT_FALSE(buffer.lookup(1.01));
  expect_near(*buffer.lookup(1.1, 0.1001), along_arc(speed, 1.1), 1e-9);
  EXPECT_FALSE(buffer.lookup(1.11, 0.1));
  expect_near(*buffer.lookup(0.99, 0.1), *buffer.lookup(0.99), 0.0);
  EXPECT_FALSE(buffer.lookup(-0.01, 0.1));  // not before the first
  buffer.add(1.02, along_arc(speed, 1.0));  // it stopped, but one pose alone does not tell how fast it is
  EXPECT_LT(buffer.lookup(1.1, 0.1)->theta, 1.08);
}

TEST(OdometryBuffer, OnePoseOrAnOldOneTellsNoSpeed) {
  OdometryBuffer buffer;
  EXPECT_FALSE(buffer.lookup(0.0, 0.1));
  buffer.add(0.0, {});
  EXPECT_FALSE(buffer.lookup(0.05, 0.1));
  buffer.add(1.0, {1.0, 0.0, 0.0});
  EXPECT_FALSE(buffer.lookup(1.05, 0.1));
}

}  // namespace
}  // namespace oort
