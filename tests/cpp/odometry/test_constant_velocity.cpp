// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "oort/odometry/constant_velocity.hpp"

namespace oort {
namespace {

TEST(ConstantVelocity, ExpectsNoMotionAtFirst) {
  ConstantVelocity velocity;
  const auto first = velocity.predict(5.0);
  EXPECT_EQ(first.T_before_after.x, 0.0);
  EXPECT_GT(first.covariance(0, 0), 0.0);
}

TEST(ConstantVelocity, GoesOnInProportionToTime) {
  ConstantVelocity velocity;
  double time = 0.0;
  for (int i = 0; i < 10; ++i, time += 0.1) {
    velocity.predict(time);
    velocity.moved({0.05, 0.0, 0.02}, true);
  }
  const auto next = velocity.predict(time + 0.05);  // 0.15 s after the last
  EXPECT_NEAR(next.T_before_after.x, 0.075, 1e-9);
  EXPECT_NEAR(next.T_before_after.theta, 0.03, 1e-9);
  velocity.moved({0.075, 0.0, 0.03}, true);
  EXPECT_LE(velocity.predict(time + 100.0).T_before_after.x, 0.15 + 1e-9);  // no more than twice the last motion
}

TEST(ConstantVelocity, MayAccelerateMoreOverALongerTime) {
  ConstantVelocity velocity;
  velocity.predict(0.0);
  const double brief = velocity.predict(0.1).covariance(2, 2);
  EXPECT_GT(velocity.predict(0.5).covariance(2, 2), 4.0 * brief);
}

TEST(ConstantVelocity, ComesToRestWithoutMatches) {
  ConstantVelocity velocity;
  double time = 0.0;
  velocity.predict(time);
  velocity.moved({0.1, 0.0, 0.0}, true);
  double total = 0.0;
  for (int i = 0; i < 50; ++i) {
    time += 0.1;
    const Pose2 on = velocity.predict(time).T_before_after;
    velocity.moved(on, false);
    total += on.x;
  }
  EXPECT_LT(total, 0.25);
}

}  // namespace
}  // namespace oort
