// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "frsm/types.hpp"
#include "frsm/velocity.hpp"
#include "scene.hpp"

namespace frsm {
namespace {

using test::kPi;

TEST(Pose, WrapsToTheHalfOpenInterval) {
  EXPECT_DOUBLE_EQ(wrap(kPi), -kPi);
  EXPECT_DOUBLE_EQ(wrap(-kPi), -kPi);
  EXPECT_NEAR(wrap(7.0), 7.0 - 2.0 * kPi, 1e-15);
  for (double angle = -50.0; angle < 50.0; angle += 0.37) {
    EXPECT_GE(wrap(angle), -kPi);
    EXPECT_LT(wrap(angle), kPi);
    EXPECT_NEAR(std::sin(wrap(angle)), std::sin(angle), 1e-12);
  }
}

TEST(Points, WithinKeepsTheOrder) {
  const Points near = within({{3.0, 4.0}, {0.0, 1.0}, {5.0, 0.1}, {-2.0, 0.0}}, 5.0);
  ASSERT_EQ(near.size(), 3u);
  EXPECT_EQ(near[0].x, 3.0);
  EXPECT_EQ(near[2].x, -2.0);
}

TEST(Pose, BetweenUndoesComposition) {
  const Pose a{1.0, -2.0, 3.0};
  const Pose b{0.3, 0.4, -2.0};
  const Pose back = between(a, a * b);
  EXPECT_NEAR(back.x, b.x, 1e-12);
  EXPECT_NEAR(back.y, b.y, 1e-12);
  EXPECT_NEAR(back.theta, b.theta, 1e-12);
}

TEST(Pose, TransformMovesPointsLikeTheProduct) {
  const Pose pose{1.0, 2.0, 0.7};
  const Points moved = transform(pose, {{0.5, -0.2}});
  const Point one = pose * Point{0.5, -0.2};
  EXPECT_DOUBLE_EQ(moved[0].x, one.x);
  EXPECT_DOUBLE_EQ(moved[0].y, one.y);
}

TEST(Pose, CovarianceTurnsWithItsFrame) {
  const Eigen::Matrix3d body = Eigen::Vector3d(4.0, 1.0, 9.0).asDiagonal();
  const Eigen::Matrix3d parent = rotate_covariance(body, kPi / 2.0);
  EXPECT_NEAR(parent(0, 0), 1.0, 1e-12);
  EXPECT_NEAR(parent(1, 1), 4.0, 1e-12);
  EXPECT_NEAR(parent(2, 2), 9.0, 1e-12);
}

TEST(Points, DropsWhatIsNotAPlace) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const Points kept = drop_invalid({{1.0, 2.0}, {kNan, 0.0}, {0.0, -kInf}, {1e300, 0.0}, {3.0, 4.0}});
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[1].x, 3.0);
}

TEST(Velocity, ContinuesACurveByTime) {
  Velocity velocity;
  const Pose step{0.1, 0.0, 0.2};
  Pose pose{1.0, 2.0, 0.5};
  for (int i = 0; i < 6; ++i, pose = pose * step) velocity.add(pose, 0.1 * i);
  const Pose next = velocity.motion_until(0.6);
  EXPECT_NEAR(next.x, 0.1, 1e-9);
  EXPECT_NEAR(next.y, 0.0, 1e-9);
  EXPECT_NEAR(next.theta, 0.2, 1e-9);
  EXPECT_NEAR(velocity.motion_until(0.55).x, 0.05, 1e-9);
}

TEST(Velocity, BearsTimesThatStepBackOrStop) {
  Velocity velocity;
  EXPECT_EQ(velocity.motion_until(1.0).x, 0.0);
  velocity.add({0.0, 0.0, 0.0}, 5.0);
  EXPECT_EQ(velocity.motion_until(6.0).x, 0.0);
  velocity.add({0.1, 0.0, 0.0}, 4.0);
  EXPECT_NEAR(velocity.motion_until(4.5).x, 0.1, 1e-12);  // times that do not tell: the same step again
  velocity.clear();
  velocity.add({0.0, 0.0, 0.0}, 1.0);
  velocity.add({0.1, 0.0, 0.0}, 1.1);
  EXPECT_NEAR(velocity.motion_until(60.0).x, 0.2, 1e-12);  // a long silence counts as two steps
}

}  // namespace
}  // namespace frsm
