// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// What odometry is doubted for, and what is taken for true instead.
#include <gtest/gtest.h>

#include <random>

#include "oort/odometry/odometry_monitor.hpp"

namespace oort {
namespace {

constexpr Pose2 kStep{0.05, 0.0, 0.02};  // in a tenth of a second

/// A robot that drives on evenly; the matches confirm its odometry.
class Driving : public ::testing::Test {
 protected:
  MotionHypotheses odometry(const Pose2& motion, double interval = 0.1) {
    return monitor.judge(time += interval, motion);
  }
  void drive(int scans, double interval = 0.1) {
    for (int k = 0; k < scans; ++k) {
      EXPECT_FALSE(odometry(kStep, interval).is_doubted());
      monitor.moved(kStep, false);
    }
  }
  double time = 100.0;
  OdometryMonitor monitor;
};

TEST_F(Driving, PlausibleMotionsAreNotDoubted) {
  std::mt19937 generator(1);
  std::normal_distribution<double> noise;
  for (int k = 0; k < 500; ++k) {
    const Pose2 motion{0.05 + 0.02 * noise(generator), 0.005 * noise(generator), 0.03 * noise(generator)};
    EXPECT_FALSE(odometry(motion, 0.1 + 0.02 * std::abs(noise(generator))).is_doubted()) << k;
    monitor.moved(motion, false);
  }
  EXPECT_EQ(monitor.fault_count(), 0u);
}

TEST_F(Driving, AJumpIsOneHypothesisAmongOthers) {
  drive(20);
  const Pose2 jump{-7.0, 3.0, 1.0};
  const MotionHypotheses hypotheses = odometry(jump);
  ASSERT_EQ(hypotheses.T_before_after.size(), 3u);
  EXPECT_NEAR(hypotheses.T_before_after[0].x, kStep.x, 1e-9) << "it goes on as before, most likely";
  EXPECT_EQ(hypotheses.T_before_after[1].x, jump.x);
  EXPECT_EQ(hypotheses.T_before_after[2].x, 0.0);
  EXPECT_FALSE(hypotheses.holds(kStep));
  monitor.moved(kStep, true);
  ASSERT_EQ(monitor.faults().size(), 1u);
  EXPECT_EQ(monitor.faults()[0].kind, OdometryFault::Kind::kJump);
  EXPECT_EQ(monitor.faults()[0].time, time);
  EXPECT_NEAR(monitor.faults()[0].distance, std::hypot(7.05, 3.0), 0.05);
  drive(5);
}

TEST_F(Driving, OdometryThatStandsStillIsFrozenOnceMuchIsMissedAndCatchesUp) {
  drive(20);
  for (int k = 0; k < 4; ++k) {
    const MotionHypotheses hypotheses = odometry({});
    ASSERT_EQ(hypotheses.T_before_after.size(), 2u);
    EXPECT_TRUE(hypotheses.is_standing);
    EXPECT_EQ(hypotheses.T_before_after[0].x, 0.0);
    EXPECT_NEAR(hypotheses.T_before_after[1].x, kStep.x, 1e-9);
    monitor.moved(kStep, !hypotheses.holds(kStep));
  }
  EXPECT_EQ(monitor.fault_count(), 1u);
  const Pose2 caught_up = kStep * kStep * kStep * kStep * kStep;
  const MotionHypotheses hypotheses = odometry(caught_up);
  ASSERT_EQ(hypotheses.T_before_after.size(), 3u);
  EXPECT_NEAR(hypotheses.T_before_after[0].x, kStep.x, 1e-9) << "what it missed is not added once more";
  EXPECT_EQ(hypotheses.T_before_after[1].x, caught_up.x);
}

TEST_F(Driving, OdometryThatComesAtEachSecondScanIsNotCountedTwice) {
  drive(20);
  for (int k = 0; k < 20; ++k) {
    odometry({});
    monitor.moved(kStep, false);  // it went on, and no match tells
    const MotionHypotheses hypotheses = odometry(kStep * kStep);
    ASSERT_EQ(hypotheses.T_before_after.size(), 3u);
    EXPECT_NEAR(hypotheses.T_before_after[0].x, kStep.x, 1e-9) << "half of it was driven already";
    monitor.moved(kStep, true);
  }
  EXPECT_EQ(monitor.fault_count(), 0u);
}

TEST_F(Driving, AJumpAfterAStandstillMayBeWhatWasDrivenMeanwhile) {
  for (int k = 0; k < 20; ++k) {  // along a bare wall a scan does not tell that it moves
    odometry({});
    monitor.moved({}, false);
  }
  const MotionHypotheses hypotheses = odometry({0.8, 0.0, 0.1});
  ASSERT_EQ(hypotheses.T_before_after.size(), 2u);
  EXPECT_EQ(hypotheses.T_before_after[0].x, 0.8);
  EXPECT_EQ(hypotheses.T_before_after[1].x, 0.0) << "odometry may have begun again";
  monitor.moved({0.8, 0.0, 0.1}, false);
  EXPECT_EQ(odometry({3.0, 0.0, 0.0}).T_before_after[1].x, 3.0) << "right after a motion it is a jump";
}

TEST_F(Driving, AJumpThatNobodyDrivesInTheTimeOfAStandstillIsAJump) {
  for (int k = 0; k < 20; ++k) {
    odometry({});
    monitor.moved({}, false);
  }
  EXPECT_EQ(odometry({5.0, 0.0, 0.0}).T_before_after[0].x, 0.0);
}

TEST_F(Driving, ARobotThatStopsIsBelievedToStand) {
  drive(20);
  const MotionHypotheses hypotheses = odometry({});
  const Pose2 noise{0.004, -0.003, 0.004};  // of a match
  EXPECT_TRUE(hypotheses.holds(noise));
  monitor.moved({}, false);
  for (int k = 0; k < 50; ++k) {
    EXPECT_FALSE(odometry({}).is_doubted()) << "it stands, nothing else is likely any more";
    monitor.moved({}, false);
  }
  EXPECT_FALSE(odometry(kStep).is_doubted());
  EXPECT_EQ(monitor.fault_count(), 0u);
}

TEST_F(Driving, StampsInBurstsAreNoAccelerations) {
  for (int k = 0; k < 60; ++k) {
    const double interval = k % 4 == 0 ? 0.4 : 0.001;
    EXPECT_FALSE(odometry(kStep, interval).is_doubted()) << k;
    monitor.moved(kStep, false);
  }
}

TEST_F(Driving, OdometryThatNeverWentBackwardsMayNotTellIt) {
  EXPECT_FALSE(odometry(kStep).T_before_after_reversed) << "so short a way is within the window";
  monitor.moved(kStep, false);
  const MotionHypotheses hypotheses = odometry({1.0, 0.05, 0.2}, 1.0);
  ASSERT_TRUE(hypotheses.T_before_after_reversed);
  EXPECT_FALSE(hypotheses.is_doubted());
  EXPECT_EQ(hypotheses.T_before_after_reversed->x, -1.0);
  EXPECT_EQ(hypotheses.T_before_after_reversed->theta, 0.2);
  monitor.moved({-1.0, -0.05, 0.2}, true);
  ASSERT_EQ(monitor.fault_count(), 1u);
  EXPECT_EQ(monitor.faults()[0].kind, OdometryFault::Kind::kReversed);
  EXPECT_FALSE(odometry({-0.5, 0.0, 0.0}, 1.0).T_before_after_reversed) << "it does tell";
  monitor.moved({-0.5, 0.0, 0.0}, false);
  EXPECT_FALSE(odometry({0.5, 0.0, 0.0}, 1.0).T_before_after_reversed);
}

TEST_F(Driving, ClocksThatAreSetBackSayNothing) {
  drive(20);
  EXPECT_FALSE(odometry(kStep, -30.0).is_doubted());
  monitor.moved(kStep, false);
  drive(5);
}

}  // namespace
}  // namespace oort
