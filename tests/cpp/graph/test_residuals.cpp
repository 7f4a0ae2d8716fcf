// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "oort/graph/internal/residuals.hpp"

namespace oort {
namespace {

class Residuals : public testing::Test {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Pose2 random_pose() { return {uniform(-5.0, 5.0), uniform(-5.0, 5.0), uniform(-M_PI, M_PI)}; }
  /// Full, with correlations between all three.
  Eigen::Matrix3d random_covariance() {
    Eigen::Matrix3d A;
    for (int k = 0; k < 9; ++k) A(k / 3, k % 3) = uniform(-1.0, 1.0);
    return 0.01 * (A * A.transpose() + 0.1 * Eigen::Matrix3d::Identity());
  }

 private:
  std::mt19937 random_{42};
};

Pose2 shifted(Pose2 pose, int coordinate, double by) {
  (coordinate == 0 ? pose.x : coordinate == 1 ? pose.y : pose.theta) += by;
  return pose;
}

TEST_F(Residuals, JacobiansMatchCentralDifferences) {
  constexpr double kStep = 1e-6;
  for (int trial = 0; trial < 50; ++trial) {
    const Pose2 i = random_pose(), j = random_pose();
    // Half a turn from the wrap, where differences would step across it.
    const Pose2 T_i_j = {uniform(-5.0, 5.0), uniform(-5.0, 5.0), wrap_angle(j.theta - i.theta + uniform(-3.0, 3.0))};
    const ErrorJacobians jacobians = constraint_jacobians(i, j);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d of_i =
          constraint_error(shifted(i, k, kStep), j, T_i_j) - constraint_error(shifted(i, k, -kStep), j, T_i_j);
      const Eigen::Vector3d of_j =
          constraint_error(i, shifted(j, k, kStep), T_i_j) - constraint_error(i, shifted(j, k, -kStep), T_i_j);
      EXPECT_LT((jacobians.of_i.col(k) - of_i / (2.0 * kStep)).norm(), 1e-7);
      EXPECT_LT((jacobians.of_j.col(k) - of_j / (2.0 * kStep)).norm(), 1e-7);
    }
  }
}

TEST_F(Residuals, ErrorIsAlongTheAxesOfNodeI) {
  const Pose2 i = {1.0, 2.0, M_PI / 2.0};
  const Eigen::Vector3d e = constraint_error(i, i * Pose2{0.5, 0.3, 0.2}, {0.4, 0.1, 0.3});
  EXPECT_TRUE(e.isApprox(Eigen::Vector3d(0.1, 0.2, -0.1), 1e-12)) << e.transpose();
}

TEST_F(Residuals, ErrorWrapsAtPi) {
  EXPECT_NEAR(constraint_error({0.0, 0.0, 3.1}, {0.0, 0.0, -3.1}, {0.0, 0.0, 0.0}).z(), 2.0 * M_PI - 6.2, 1e-12);
  EXPECT_NEAR(constraint_error({0.0, 0.0, -3.1}, {0.0, 0.0, 3.0}, {0.0, 0.0, -0.1}).z(), 6.2 - 2.0 * M_PI, 1e-12);
  // Unwrapped headings, as the solver holds them, give the same error.
  const Eigen::Vector3d near = constraint_error({0.0, 0.0, 3.0}, {0.1, 0.2, -0.2}, {0.1, 0.2, 3.0});
  const Eigen::Vector3d turned =
      constraint_error({0.0, 0.0, 3.0 + 2.0 * M_PI}, {0.1, 0.2, -0.2 - 4.0 * M_PI}, {0.1, 0.2, 3.0});
  EXPECT_LT((near - turned).norm(), 1e-12);
}

TEST_F(Residuals, WhitenedSquareIsTheMahalanobisDistance) {
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Matrix3d covariance = random_covariance();
    const Pose2 i = random_pose(), j = random_pose(), T_i_j = random_pose();
    const Eigen::Vector3d e = constraint_error(i, j, T_i_j);
    const double expected = e.dot(covariance.inverse() * e);

    const Eigen::Matrix3d W = whitening_matrix(covariance, Whitening::kCorrect);
    EXPECT_NEAR((W * e).squaredNorm(), expected, 1e-9 * expected);
  }
}

TEST_F(Residuals, OriginalWhiteningIsTheLowerFactorOfTheInformation) {
  const Eigen::Matrix3d covariance = random_covariance();
  const Eigen::Matrix3d L = whitening_matrix(covariance, Whitening::kOriginal);
  EXPECT_TRUE(L.isLowerTriangular());
  EXPECT_TRUE((L * L.transpose() * covariance).isIdentity(1e-9));
  EXPECT_EQ(L.transpose(), whitening_matrix(covariance, Whitening::kCorrect));
}

TEST_F(Residuals, RoundingAsymmetryIsRepaired) {
  Eigen::Matrix3d covariance = random_covariance();
  const Eigen::Matrix3d W = whitening_matrix(covariance, Whitening::kCorrect);
  covariance(0, 1) *= 1.0 + 1e-13;
  EXPECT_TRUE(whitening_matrix(covariance, Whitening::kCorrect).isApprox(W, 1e-9));
}

}  // namespace
}  // namespace oort
