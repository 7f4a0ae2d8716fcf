// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// What a match says of its own accuracy and what it does where it sees nothing.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "frsm/matcher.hpp"
#include "scene.hpp"

namespace frsm {
namespace {

using test::kPi;
using test::Sensor;

struct Trial {
  Eigen::Vector3d error;
  Match match;
};

Trial run(const test::Scene& scene, const Sensor& sensor, const Pose& seen_from, const Pose& truth, const Prior* prior,
          std::mt19937& random) {
  const Points drawn = test::scan(scene, seen_from, sensor, random);
  const Points body = test::scan(scene, truth, sensor, random);
  Table table;
  table.draw(transform(seen_from, drawn), extract_contours(drawn, {}), seen_from);
  Trial trial;
  trial.match = Matcher().match(table, body, prior != nullptr ? prior->mean : seen_from, {0.15, 0.15, 0.15}, prior);
  const Pose& pose = trial.match.pose;
  trial.error = {pose.x - truth.x, pose.y - truth.y, wrap(pose.theta - truth.theta)};
  return trial;
}

// The default information_scale is for 1.5 cm of range noise.
TEST(Covariance, ErrorsAreAsLargeAsItSaysInARoom) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> small(-0.08, 0.08);
  std::uniform_real_distribution<double> angle(-kPi, kPi);
  double nees = 0.0;
  constexpr int kTrials = 500;
  for (int i = 0; i < kTrials; ++i) {
    const Pose from{small(random), 0.4 + small(random), angle(random)};
    const Trial trial = run(test::room(angle(random)), {181, kPi, 8.0, 0.015}, from,
                            from * Pose{small(random), small(random), small(random)}, nullptr, random);
    nees += trial.error.dot(trial.match.covariance.inverse() * trial.error) / kTrials;
  }
  EXPECT_GT(nees, 2.0);
  EXPECT_LT(nees, 4.5);
}

TEST(Covariance, TwiceThePointsTellTwiceAsMuch) {
  std::mt19937 random(2);
  const Pose pose{0.1, 0.4, 0.3};
  const auto information = [&](int beams) {
    return run(test::room(0.2), {beams, kPi, 8.0, 0.01}, pose, pose, nullptr, random).match.information.trace();
  };
  EXPECT_NEAR(information(181) / information(91), 2.0, 0.3);
}

TEST(Covariance, LiesAlongACorridor) {
  for (const double heading : {0.0, 0.4, 1.2}) {
    std::mt19937 random(3);
    test::Scene scene = test::corridor();
    for (test::Wall& wall : scene) {
      wall.a = Pose{0.0, 0.0, heading} * wall.a;
      wall.b = Pose{0.0, 0.0, heading} * wall.b;
    }
    const Trial trial = run(scene, {181, kPi, 6.0, 0.01}, {0.0, 0.0, heading}, {0.0, 0.0, heading}, nullptr, random);
    EXPECT_EQ(trial.match.status, Status::kDegenerate);
    EXPECT_TRUE(trial.match.degenerate);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(trial.match.covariance.topLeftCorner<2, 2>());
    const Eigen::Vector2d along = eigen.eigenvectors().col(1);
    EXPECT_GT(std::abs(along.dot(Eigen::Vector2d(std::cos(heading), std::sin(heading)))), std::cos(5.0 * kPi / 180.0));
    EXPECT_GE(std::sqrt(eigen.eigenvalues()[1]), 0.15 * 0.99);
    EXPECT_LT(std::sqrt(eigen.eigenvalues()[0]), 0.01);
    const Eigen::Matrix2d information = trial.match.information.topLeftCorner<2, 2>();
    const Eigen::Vector2d axis(std::cos(heading), std::sin(heading));
    EXPECT_LT(axis.dot(information * axis), 0.01 * information.trace());
  }
}

TEST(Covariance, RoomIsNotDegenerate) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> angle(-kPi, kPi);
  for (int i = 0; i < 50; ++i) {
    const Pose pose{0.1, 0.4, angle(random)};
    EXPECT_EQ(run(test::room(angle(random)), {181, kPi, 8.0, 0.01}, pose, pose, nullptr, random).match.status,
              Status::kOk);
  }
}

TEST(Covariance, SmallFeatureInACorridorIsSeen) {
  std::mt19937 random(5);
  test::Scene scene = test::corridor();
  test::add_box(&scene, {1.5, 0.8, 0.0}, 0.4, 0.4);
  for (int i = 0; i < 20; ++i) {
    const Trial trial = run(scene, {181, kPi, 6.0, 0.01}, {}, {0.05, 0.02, 0.03}, nullptr, random);
    EXPECT_EQ(trial.match.status, Status::kOk);
    EXPECT_LT(trial.error.head<2>().norm(), 0.02);
  }
}

TEST(Prior, LeadsAlongACorridor) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> off(-0.1, 0.1);
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.0025, 0.0025, 0.0025).asDiagonal();
  for (int i = 0; i < 50; ++i) {
    const Prior prior{{off(random), 0.03, 0.02}, covariance};
    const Trial trial = run(test::corridor(), {181, kPi, 6.0, 0.01}, {}, {0.0, 0.0, 0.0}, &prior, random);
    EXPECT_EQ(trial.match.status, Status::kDegenerate);
    EXPECT_NEAR(trial.match.pose.x, prior.mean.x, 1e-3);
    EXPECT_NEAR(trial.match.pose.y, 0.0, 0.01);
    EXPECT_NEAR(trial.match.pose.theta, 0.0, 5e-3);
    EXPECT_NEAR(std::sqrt(trial.match.covariance(0, 0)), 0.05, 1e-3);
  }
}

TEST(Prior, SharpPriorHoldsAndFlatOneLetsGo) {
  std::mt19937 random(7);
  const Pose truth{0.1, 0.4, 0.3};
  const Pose mean{0.15, 0.4, 0.3};
  const Prior sharp{mean, 1e-8 * Eigen::Matrix3d::Identity()};
  const Prior flat{mean, Eigen::Matrix3d::Identity()};
  EXPECT_NEAR(run(test::room(), {181, kPi, 8.0, 0.01}, truth, truth, &sharp, random).match.pose.x, mean.x, 2e-3);
  EXPECT_NEAR(run(test::room(), {181, kPi, 8.0, 0.01}, truth, truth, &flat, random).match.pose.x, truth.x, 5e-3);
}

}  // namespace
}  // namespace frsm
