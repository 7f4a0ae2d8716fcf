// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <vector>

#include "oort/graph/residuals.hpp"

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

using Values = std::vector<std::vector<double>>;

std::vector<double> evaluate(const ceres::CostFunction& function, const Values& values) {
  std::vector<const double*> pointers;
  for (const auto& block : values) pointers.push_back(block.data());
  std::vector<double> residuals(static_cast<std::size_t>(function.num_residuals()));
  EXPECT_TRUE(function.Evaluate(pointers.data(), residuals.data(), nullptr));
  return residuals;
}

/// Compares each analytic Jacobian, asked for alone, with central differences.
void check_jacobians(const ceres::CostFunction& function, const Values& values) {
  std::vector<const double*> pointers;
  for (const auto& block : values) pointers.push_back(block.data());
  const auto rows = static_cast<std::size_t>(function.num_residuals());
  for (std::size_t block = 0; block < values.size(); ++block) {
    const std::size_t columns = values[block].size();
    std::vector<double> residuals(rows), analytic(rows * columns);
    std::vector<double*> jacobians(values.size(), nullptr);
    jacobians[block] = analytic.data();
    ASSERT_TRUE(function.Evaluate(pointers.data(), residuals.data(), jacobians.data()));
    EXPECT_EQ(residuals, evaluate(function, values));
    for (std::size_t column = 0; column < columns; ++column) {
      constexpr double kStep = 1e-6;
      Values up = values, down = values;
      up[block][column] += kStep;
      down[block][column] -= kStep;
      const std::vector<double> above = evaluate(function, up), below = evaluate(function, down);
      for (std::size_t row = 0; row < rows; ++row) {
        EXPECT_NEAR(analytic[row * columns + column], (above[row] - below[row]) / (2.0 * kStep), 1e-6)
            << "block " << block << " row " << row << " column " << column;
      }
    }
  }
}

std::vector<double> values_of(const Pose2& pose) {
  return {pose.x, pose.y, pose.theta};
}

TEST_F(Residuals, JacobiansMatchCentralDifferences) {
  for (int trial = 0; trial < 50; ++trial) {
    const Pose2 i = random_pose(), j = random_pose();
    // Half a turn from the wrap, where differences would step across it.
    const Pose2 T_i_j = {uniform(-5.0, 5.0), uniform(-5.0, 5.0), wrap_angle(j.theta - i.theta + uniform(-3.0, 3.0))};
    for (const Whitening whitening : {Whitening::kCorrect, Whitening::kOriginal}) {
      const Eigen::Matrix3d W = whitening_matrix(random_covariance(), whitening);
      check_jacobians(ChainResidual(T_i_j, W), {values_of(i), values_of(j)});
      check_jacobians(SwitchableResidual(T_i_j, W), {values_of(i), values_of(j), {uniform(0.0, 1.0)}});
    }
    check_jacobians(SwitchPrior(uniform(0.1, 10.0)), {{uniform(0.0, 1.0)}});
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
  // Unwrapped headings, as the solver may hold them, give the same residual.
  const Eigen::Matrix3d W = whitening_matrix(random_covariance(), Whitening::kCorrect);
  const ChainResidual residual({0.1, 0.2, 3.0}, W);
  const std::vector<double> near = evaluate(residual, {{0.0, 0.0, 3.0}, {0.1, 0.2, -0.2}});
  const std::vector<double> turned = evaluate(residual, {{0.0, 0.0, 3.0 + 2.0 * M_PI}, {0.1, 0.2, -0.2 - 4.0 * M_PI}});
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(near[k], turned[k], 1e-9);
}

TEST_F(Residuals, WhitenedSquareIsTheMahalanobisDistance) {
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Matrix3d covariance = random_covariance();
    const Pose2 i = random_pose(), j = random_pose(), T_i_j = random_pose();
    const Eigen::Vector3d e = constraint_error(i, j, T_i_j);
    const double expected = e.dot(covariance.inverse() * e);

    const Eigen::Matrix3d W = whitening_matrix(covariance, Whitening::kCorrect);
    const std::vector<double> r = evaluate(ChainResidual(T_i_j, W), {values_of(i), values_of(j)});
    EXPECT_NEAR(r[0] * r[0] + r[1] * r[1] + r[2] * r[2], expected, 1e-9 * expected);

    const std::vector<double> half = evaluate(SwitchableResidual(T_i_j, W), {values_of(i), values_of(j), {0.5}});
    for (std::size_t k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(half[k], 0.5 * r[k]);
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
