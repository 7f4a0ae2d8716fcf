// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "oort/geometry/errors.hpp"
#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/odometry/odometry_buffer.hpp"
#include "oort/odometry/odometry_model.hpp"

namespace oort {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

class RandomPoses {
 public:
  Pose2 operator()() { return {uniform_(engine_) * 5.0, uniform_(engine_) * 5.0, wrap_angle(uniform_(engine_) * 4.0)}; }
  double value() { return uniform_(engine_); }

 private:
  std::mt19937 engine_{7};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

void expect_near(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(wrap_angle(a.theta - b.theta), 0.0, tolerance);
}

Eigen::Vector3d vector_of(const Pose2& pose) {
  return {pose.x, pose.y, pose.theta};
}

TEST(WrapAngle, StaysInTheHalfOpenInterval) {
  EXPECT_EQ(wrap_angle(M_PI), -M_PI);
  EXPECT_EQ(wrap_angle(-M_PI), -M_PI);
  EXPECT_EQ(wrap_angle(0.3), 0.3);
  for (double angle = -50.0; angle < 50.0; angle += 0.0137) {
    const double wrapped = wrap_angle(angle);
    EXPECT_GE(wrapped, -M_PI);
    EXPECT_LT(wrapped, M_PI);
    EXPECT_NEAR(std::remainder(wrapped - angle, 2 * M_PI), 0.0, 1e-12);
  }
}

TEST(Pose2, IsAGroup) {
  RandomPoses random;
  for (int i = 0; i < 1000; ++i) {
    const Pose2 a = random();
    const Pose2 b = random();
    const Pose2 c = random();
    expect_near((a * b) * c, a * (b * c), 1e-12);
    expect_near(a * inverse(a), {}, 1e-12);
    expect_near(between(a, b), inverse(a) * b, 1e-12);
    const Eigen::Vector2d p(random.value(), random.value());
    EXPECT_NEAR(((a * b) * p - a * (b * p)).norm(), 0.0, 1e-12);
  }
}

TEST(Pose2, InterpolatesTheShorterWayAround) {
  const Pose2 middle = interpolate({0, 0, 3.0}, {1, 2, -3.0}, 0.5);
  expect_near(middle, {0.5, 1.0, -M_PI}, 1e-12);
}

// Numeric Jacobians of the two operations, against which the closed forms are held.
Eigen::Matrix3d jacobian(const std::function<Pose2(const Pose2&)>& f, const Pose2& at) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix3d J;
  for (int i = 0; i < 3; ++i) {
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
    d[i] = kStep;
    const Pose2 plus = f({at.x + d[0], at.y + d[1], at.theta + d[2]});
    const Pose2 minus = f({at.x - d[0], at.y - d[1], at.theta - d[2]});
    J.col(i) = vector_of({plus.x - minus.x, plus.y - minus.y, wrap_angle(plus.theta - minus.theta)}) / (2 * kStep);
  }
  return J;
}

Eigen::Matrix3d some_covariance(RandomPoses& random) {
  Eigen::Matrix3d a;
  for (int i = 0; i < 9; ++i) a(i / 3, i % 3) = random.value();
  return a * a.transpose() + 0.1 * Eigen::Matrix3d::Identity();
}

TEST(Covariance, CompoundAndInverseFollowTheNumericJacobians) {
  RandomPoses random;
  for (int i = 0; i < 50; ++i) {
    const Pose2 a = random();
    const Pose2 b = random();
    const Eigen::Matrix3d sa = some_covariance(random);
    const Eigen::Matrix3d sb = some_covariance(random);
    const Eigen::Matrix3d Ja = jacobian([&](const Pose2& p) { return p * b; }, a);
    const Eigen::Matrix3d Jb = jacobian([&](const Pose2& p) { return a * p; }, b);
    const Eigen::Matrix3d expected = Ja * sa * Ja.transpose() + Jb * sb * Jb.transpose();
    EXPECT_LT((compound_covariance(a, sa, b, sb) - expected).norm(), 1e-6 * expected.norm());
    const Eigen::Matrix3d Ji = jacobian([](const Pose2& p) { return inverse(p); }, a);
    EXPECT_LT((inverse_covariance(a, sa) - Ji * sa * Ji.transpose()).norm(), 1e-6 * expected.norm());
  }
}

LaserScan scan_of(std::vector<float> ranges) {
  return {12.5, -M_PI / 2, M_PI / 2, 0.1, 3.0, std::move(ranges)};
}

TEST(PointCloud, KeepsWhatTheSchemaSays) {
  const PointCloud cloud = to_point_cloud(scan_of({1.0F, 3.0F, 0.05F, kInf, static_cast<float>(kNan), -kInf}));
  ASSERT_EQ(cloud.points.size(), 6U);
  EXPECT_EQ(cloud.time, 12.5);
  EXPECT_TRUE(cloud.points[0].is_return());
  EXPECT_NEAR(cloud.points[0].y, -1.0, 1e-7);
  EXPECT_FALSE(cloud.points[1].is_return());  // at range_max: no return, but its place is kept
  EXPECT_NEAR(cloud.points[1].x, 3.0, 1e-6);
  EXPECT_FALSE(cloud.points[2].is_return());  // below range_min
  EXPECT_NEAR(cloud.points[2].y, 0.05, 1e-7);
  EXPECT_EQ(cloud.points[3].x, kInf);
  EXPECT_EQ(cloud.points[3].y, -M_PI / 2 + 3 * (M_PI / 2));  // the beam's bearing
  EXPECT_TRUE(std::isnan(cloud.points[4].x));
  EXPECT_TRUE(std::isnan(cloud.points[5].x));  // "too close" is unknown, not far
  EXPECT_EQ(count_returns(cloud), 1U);
  EXPECT_EQ(static_cast<float>(cloud.points[0].x), cloud.points[0].x);  // float32, as in the file
}

TEST(PointCloud, AnyNumberOfBeamsAndNoNonsense) {
  EXPECT_TRUE(to_point_cloud(scan_of({})).points.empty());
  LaserScan scan = scan_of({1.0F});
  scan.angle_min = kNan;
  EXPECT_THROW(to_point_cloud(scan), InputError);
}

TEST(PointCloud, NoLaserSeesFartherThanIndoors) {
  LaserScan scan = scan_of({1.0F, 149.0F, 150.0F, 1e6F, 1e20F, -1e20F});
  scan.angle_increment = 0.1;
  scan.range_max = kInf;
  const PointCloud cloud = to_point_cloud(scan);
  EXPECT_EQ(count_returns(cloud), 2U);
  for (const int k : {2, 3, 4}) {
    EXPECT_EQ(cloud.points[k].x, kInf);
    EXPECT_EQ(cloud.points[k].y, scan.angle_min + 0.1 * k);
  }
  EXPECT_TRUE(std::isnan(cloud.points[5].x));
}

TEST(PointCloud, BeamsSpreadOverATurnOrLess) {
  for (const double increment : {0.0, 1e-300, 1e300, -1e300, 7.0}) {
    LaserScan scan = scan_of({1.0F, 1.0F});
    scan.angle_increment = increment;
    EXPECT_THROW(to_point_cloud(scan), InputError) << increment;
  }
  LaserScan scan = scan_of({1.0F, 1.0F});
  scan.angle_min = 1e300;
  EXPECT_THROW(to_point_cloud(scan), InputError);
  LaserScan many = scan_of({});
  many.ranges.resize(1'000'001);
  many.angle_increment = 1e-6;
  EXPECT_THROW(to_point_cloud(many), InputError);
}

TEST(OdometryBuffer, InterpolatesAndKeepsOrder) {
  OdometryBuffer buffer;
  buffer.add(1.0, {0, 0, 3.0});
  buffer.add(3.0, {2, 0, -3.0});
  buffer.add(2.0, {1, 1, -M_PI});  // late
  expect_near(*buffer.lookup(1.5), {0.5, 0.5, 3.0 + (M_PI - 3.0) / 2}, 1e-12);
  expect_near(*buffer.lookup(2.0), {1, 1, -M_PI}, 0.0);
  EXPECT_FALSE(buffer.lookup(0.9));
  EXPECT_FALSE(buffer.lookup(3.1));
  buffer.add(2.0, {5, 5, 0});  // said again: replaced
  EXPECT_EQ(buffer.lookup(2.0)->x, 5.0);
  EXPECT_EQ(buffer.size(), 3U);
  EXPECT_THROW(buffer.add(kNan, {}), InputError);
}

TEST(OdometryBuffer, ForgetsBeyondItsHorizon) {
  OdometryBuffer buffer(1.0);
  for (int i = 0; i <= 100; ++i) buffer.add(0.1 * i, {0.1 * i, 0, 0});
  EXPECT_LE(buffer.size(), 12U);
  EXPECT_FALSE(buffer.lookup(5.0));
}

TEST(OdometryModel, DoesNotCareHowAMotionIsCutIntoSteps) {
  const OdometryModel model{0.03, 0.01, 0.02, 0.05, 0.0, 0.0};
  const Eigen::Matrix3d whole = model.covariance({1.0, 0.0, 0.5});
  Eigen::Matrix3d steps = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 10; ++i) steps += model.covariance({0.1, 0.0, 0.05});
  EXPECT_LT((whole - steps).norm(), 1e-12);
}

}  // namespace
}  // namespace oort
