// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Odometry that turns by a gyro.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "oort/geometry/errors.hpp"
#include "oort/odometry/gyro_odometry.hpp"

namespace oort {
namespace {

constexpr double kStep = 0.02;  // [s]
constexpr double kBias = 0.013;

/// True motion: it stands for two seconds, then drives a curve, each step along an arc, and turns on the spot.
double rate_at(double time) {
  return time < 2.0 ? 0.0 : time < 8.0 ? 0.5 * std::sin(time - 2.0) : 1.0;
}
double speed_at(double time) {
  return time < 2.0 || time >= 8.0 ? 0.0 : 0.3;
}

struct Drive {
  std::vector<TimedPose> truth, odometry;
  std::vector<double> rates;  // at the same times
};

/// Odometry whose turns err by a quarter and by noise.
Drive make_drive(int steps = 500) {
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  Drive drive;
  TimedPose truth{0.0, {1.0, 2.0, 0.5}}, odometry = truth;
  for (int k = 0; k <= steps; ++k) {
    const double time = kStep * k;
    drive.truth.push_back({time, truth.pose});
    drive.odometry.push_back({time, odometry.pose});
    drive.rates.push_back(rate_at(time) + kBias);
    const double turn = 0.5 * (rate_at(time) + rate_at(time + kStep)) * kStep;
    const double way = speed_at(time) * kStep;
    const double told = turn == 0.0 ? 0.0 : 1.25 * turn + 0.01 * normal(generator);
    truth.pose = truth.pose * Pose2{way * std::cos(0.5 * turn), way * std::sin(0.5 * turn), turn};
    odometry.pose = odometry.pose * Pose2{way * std::cos(0.5 * told), way * std::sin(0.5 * told), told};
  }
  return drive;
}

std::vector<TimedPose> run(const Drive& drive, int gyro_ahead, int gyro_until = 1 << 30) {
  GyroOdometry odometry;
  std::vector<TimedPose> poses;
  const int n = static_cast<int>(drive.odometry.size());
  int told = 0;
  for (int k = 0; k < n; ++k) {
    for (; told <= std::min({k + gyro_ahead, n - 1, gyro_until}); ++told) {
      odometry.add_gyro(kStep * told, drive.rates[static_cast<std::size_t>(told)]);
    }
    odometry.add_odometry(drive.odometry[static_cast<std::size_t>(k)].time,
                          drive.odometry[static_cast<std::size_t>(k)].pose);
    for (const TimedPose& pose : odometry.take()) poses.push_back(pose);
  }
  for (; told < std::min(n, gyro_until); ++told)
    odometry.add_gyro(kStep * told, drive.rates[static_cast<std::size_t>(told)]);
  odometry.flush();
  for (const TimedPose& pose : odometry.take()) poses.push_back(pose);
  return poses;
}

TEST(GyroOdometry, TurnsByTheGyroLessItsBias) {
  const Drive drive = make_drive();
  const std::vector<TimedPose> poses = run(drive, 0);
  ASSERT_EQ(poses.size(), drive.truth.size());
  const Pose2 error = between(drive.truth.back().pose, poses.back().pose);
  EXPECT_LT(error.translation().norm(), 0.01);
  EXPECT_LT(std::abs(error.theta), 0.005);
  const Pose2 without = between(drive.truth.back().pose, drive.odometry.back().pose);
  EXPECT_GT(std::abs(without.theta), 0.2);
}

TEST(GyroOdometry, DoesNotDependOnHowTheStreamsMingle) {
  const Drive drive = make_drive();
  const std::vector<TimedPose> expected = run(drive, 0);
  for (const int ahead : {-40, -3, 5, 1000}) {
    const std::vector<TimedPose> poses = run(drive, ahead);
    ASSERT_EQ(poses.size(), expected.size());
    for (std::size_t k = 0; k < poses.size(); ++k) {
      EXPECT_EQ(poses[k].time, expected[k].time);
      EXPECT_EQ(poses[k].pose.x, expected[k].pose.x);
      EXPECT_EQ(poses[k].pose.theta, expected[k].pose.theta);
    }
  }
}

TEST(GyroOdometry, GoesOnWithOdometryWhereTheGyroEnds) {
  const Drive drive = make_drive();
  const std::vector<TimedPose> poses = run(drive, 0, 200);
  ASSERT_EQ(poses.size(), drive.truth.size());
  const Pose2 step = between(poses[300].pose, poses[400].pose);
  const Pose2 told = between(drive.odometry[300].pose, drive.odometry[400].pose);
  EXPECT_NEAR(step.theta, told.theta, 1e-12);
  EXPECT_NEAR(step.x, told.x, 1e-12);
}

TEST(GyroOdometry, LearnsItsBiasOnlyWhereTheBaseStands) {
  GyroOdometry odometry;
  std::mt19937_64 generator(1);
  std::normal_distribution<double> noise(0.0, 0.01);
  EXPECT_FALSE(odometry.bias());
  for (int k = 0; k < 200; ++k) {  // never at rest
    odometry.add_gyro(kStep * k, 0.5 + kBias);
    odometry.add_odometry(kStep * k, {0.01 * k, 0.0, 0.0});
  }
  EXPECT_FALSE(odometry.bias());
  EXPECT_EQ(odometry.steps_by_gyro(), 0U);
  for (int k = 200; k < 700; ++k) {
    const bool carried = k > 450 && k < 550;  // somebody turns it while the wheels stand
    odometry.add_gyro(kStep * k, kBias + noise(generator) + (carried ? 0.8 : 0.0));
    odometry.add_odometry(kStep * k, {2.0, 0.0, 0.0});
  }
  ASSERT_TRUE(odometry.bias());
  EXPECT_NEAR(*odometry.bias(), kBias, 0.003);
}

TEST(GyroOdometry, AtRestItIsAtRest) {
  GyroOdometry odometry;
  for (int k = 0; k < 500; ++k) {
    odometry.add_gyro(kStep * k, kBias + (k % 2 == 0 ? 0.01 : -0.01));
    odometry.add_odometry(kStep * k, {1.0, 1.0, 1.0});
  }
  for (const TimedPose& pose : odometry.take()) EXPECT_EQ(pose.pose.theta, 1.0);
}

/// A gyro and odometry that tell the same of a base which turns by 1 rad/s after it stood for two seconds.
void turn(GyroOdometry& odometry, int begin, int end, double set_back = 0.0) {
  for (int k = begin; k < end; ++k) {
    odometry.add_gyro(kStep * k - set_back, kBias + (k >= 100 ? 1.0 : 0.0));
    odometry.add_odometry(kStep * k - set_back, {0.0, 0.0, k > 100 ? kStep * 0.5 * (k - 100) : 0.0});
  }
}

TEST(GyroOdometry, ABiasThatWasLearnedWrongIsLearnedAnew) {
  GyroOdometry odometry;
  std::mt19937_64 generator(2);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (int k = 0; k < 1500; ++k) {  // somebody turns it for its first three seconds, the wheels stand
    odometry.add_gyro(kStep * k, kBias + noise(generator) + (k < 150 ? 0.1 : 0.0));
    odometry.add_odometry(kStep * k, {2.0, 0.0, 0.0});
  }
  ASSERT_TRUE(odometry.bias());
  EXPECT_NEAR(*odometry.bias(), kBias, 0.003);
}

TEST(GyroOdometry, ADeadGyroIsNotBelieved) {
  GyroOdometry odometry;
  double heading = 0.0;
  for (int k = 0; k < 1000; ++k) {
    odometry.add_gyro(kStep * k, 0.0);
    heading = k < 100 ? 0.0 : kStep * 0.5 * (k - 100);
    odometry.add_odometry(kStep * k, {0.0, 0.0, wrap_angle(heading)});
  }
  odometry.flush();
  EXPECT_LT(std::abs(wrap_angle(odometry.take().back().pose.theta - heading)), 0.55) << "but for its first second";
}

TEST(GyroOdometry, AWrongStampCostsAMoment) {
  GyroOdometry odometry;
  turn(odometry, 0, 200);
  odometry.add_gyro(1e9, 0.0);
  turn(odometry, 200, 300);
  odometry.add_gyro(1.0, 0.0);  // much too late
  turn(odometry, 300, 400);
  EXPECT_LE(odometry.steps_by_odometry(), 80U);  // the 75 before the bias is known, and a few
  EXPECT_GE(odometry.steps_by_gyro(), 320U);
}

TEST(GyroOdometry, GoesOnWhereTheClockIsSetBack) {
  GyroOdometry odometry;
  turn(odometry, 0, 200);
  const std::vector<TimedPose> before = odometry.take();
  const double bias = odometry.bias().value();
  odometry.set_back(kStep * 200 - 2.0);
  turn(odometry, 200, 300, 2.0);
  const std::vector<TimedPose> after = odometry.take();
  ASSERT_EQ(after.size(), 100U);
  EXPECT_NEAR(after.front().time, 2.0, 1e-9);
  EXPECT_NEAR(wrap_angle(after.front().pose.theta - before.back().pose.theta), 0.5 * kStep, 1e-9);  // odometry's turn
  EXPECT_NEAR(wrap_angle(after.back().pose.theta - after.front().pose.theta), 99 * kStep, 1e-3);    // the gyro's
  EXPECT_EQ(odometry.bias().value(), bias);
}

TEST(GyroOdometry, KeepsRatesForAWhile) {
  GyroOdometry odometry;
  for (int k = 0; k <= 1500; ++k) odometry.add_gyro(kStep * k, kBias);  // 30 s
  for (int k = 0; k <= 1500; ++k) odometry.add_odometry(kStep * k, {});
  EXPECT_NEAR(static_cast<double>(odometry.steps_by_gyro()), 950.0, 3.0);  // of the last 20 s, but for the bias' second
}

TEST(GyroOdometry, LeavesOutWhatIsLateAndRefusesNonsense) {
  GyroOdometry odometry;
  odometry.add_gyro(1.0, 0.1);
  odometry.add_gyro(0.5, 9.0);
  odometry.add_odometry(1.0, {});
  odometry.add_odometry(1.0, {5.0, 0.0, 0.0});
  EXPECT_EQ(odometry.take().size(), 1U);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(odometry.add_gyro(2.0, kNan), InputError);
  EXPECT_THROW(odometry.add_gyro(kNan, 0.0), InputError);
  EXPECT_THROW(odometry.add_odometry(2.0, {kNan, 0.0, 0.0}), InputError);
}

}  // namespace
}  // namespace oort
