// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "matching_scenes.hpp"
#include "oort/geometry/errors.hpp"
#include "oort/matching/ceres_matcher.hpp"
#include "oort/matching/correlative_matcher.hpp"
#include "oort/matching/grid_score.hpp"
#include "oort/matching/internal/matching_costs.hpp"

namespace oort {
namespace {

using testing::grid_of_room;
using testing::kPi;
using testing::random_cloud;
using testing::random_grid;
using testing::seen_from;

constexpr ProbabilityGridParameters kCoarse{0.05, true, 0.55, 0.49};
constexpr ProbabilityGridParameters kFine{0.025, false, 0.55, 0.49};
constexpr CeresScanMatcherParameters kCeres{20.0, 1.0, 1.0, 0.5, {true, 50, 1}};
const Pose2 kTruth{-1.4, -0.9, 0.5};

double distance(const Pose2& a, const Pose2& b) {
  return between(a, b).translation().norm();
}

TEST(AngularStep, MovesTheFarthestPointByACell) {
  const Points points{{3.0, 0.0}, {0.0, -5.0}, {1.0, 1.0}};
  const double step = angular_step(points, 0.05);
  EXPECT_NEAR(2.0 * 5.0 * std::sin(0.5 * step), 0.05, 1e-12);
  EXPECT_LT(angular_step({}, 0.05), 0.5) << "no point is far: still a step";
}

TEST(CorrelativeMatcher, FindsAKnownOffset) {
  const ProbabilityGrid grid = grid_of_room(kCoarse);
  const CorrelativeMatcher matcher(grid, {0.2, 0.2, 0.1, 0.1});
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> off(-0.15, 0.15);
    const Pose2 guess{kTruth.x + off(random), kTruth.y + off(random), kTruth.theta + off(random)};
    const ScanMatch match = matcher.match(seen_from(kTruth, seed + 100), guess);
    EXPECT_EQ(match.rejection, Rejection::kNone);
    EXPECT_LT(distance(match.pose, kTruth), 0.05);
    EXPECT_NEAR(match.pose.theta, kTruth.theta, 0.025);
    EXPECT_GT(match.inlier_ratio, 0.8);
  }
}

TEST(CorrelativeMatcher, IsPulledToTheGuessByItsWeights) {
  const ProbabilityGrid grid = grid_of_room(kCoarse);
  const Points points = seen_from(kTruth, 5);
  const Pose2 guess{kTruth.x + 0.1, kTruth.y, kTruth.theta};
  const ScanMatch free = CorrelativeMatcher(grid, {0.2, 0.0, 0.0, 0.0}).match(points, guess);
  const ScanMatch held = CorrelativeMatcher(grid, {0.2, 0.0, 30.0, 0.0}).match(points, guess);
  EXPECT_GT(distance(free.pose, guess), 0.06);
  EXPECT_LT(distance(held.pose, guess), 0.01);
}

TEST(CorrelativeMatcher, StaysWhereNothingIsKnown) {
  const ProbabilityGrid empty(GridLimits{0.05, 0.0, 0.0, 10, 10});
  const Pose2 guess{0.2, 0.1, 0.3};
  const ScanMatch match = CorrelativeMatcher(empty, {0.2, 0.2, 0.0, 0.0}).match(seen_from(kTruth, 5), guess);
  EXPECT_EQ(distance(match.pose, guess), 0.0) << "of equal scores that nearest to the guess";
  EXPECT_NEAR(match.score, 0.1, 1e-9);
  EXPECT_EQ(match.inlier_ratio, 0.0);
}

TEST(CeresMatcher, RefinesToAFractionOfACell) {
  const ProbabilityGrid grid = grid_of_room(kFine);
  const CeresMatcher matcher(grid, kCeres);
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> off(-0.03, 0.03);
    const Pose2 guess{kTruth.x + off(random), kTruth.y + off(random), kTruth.theta + 0.5 * off(random)};
    const ScanMatch match = matcher.match(seen_from(kTruth, seed + 100), guess);
    EXPECT_LT(distance(match.pose, kTruth), 0.012);
    EXPECT_NEAR(match.pose.theta, kTruth.theta, 0.006);
  }
}

TEST(CeresMatcher, WeightsHoldPositionAndHeading) {
  const ProbabilityGrid grid = grid_of_room(kFine);
  const Points points = seen_from(kTruth, 5);
  const Pose2 guess{kTruth.x + 0.03, kTruth.y - 0.02, kTruth.theta + 0.02};
  CeresScanMatcherParameters held = kCeres;
  held.previous_pose_translation_delta_cost_functor_weight = 1e4;
  held.initial_pose_estimate_rotation_delta_cost_functor_weight = 1e4;
  const ScanMatch match = CeresMatcher(grid, held).match(points, guess);
  EXPECT_LT(distance(match.pose, guess), 1e-3);
  EXPECT_NEAR(match.pose.theta, guess.theta, 1e-3);
  const ScanMatch elsewhere = CeresMatcher(grid, held).match(points, guess, {kTruth.x, kTruth.y});
  EXPECT_LT(distance(elsewhere.pose, kTruth), 1e-3) << "the position of another pose than the guess";
}

TEST(CeresMatcher, CovarianceIsOfTheSolutionAndScaled) {
  const ProbabilityGrid grid = grid_of_room(kFine);
  const Points points = seen_from(kTruth, 5);
  CeresScanMatcherParameters twice = kCeres;
  twice.covariance_scale *= 2.0;
  const ScanMatch a = CeresMatcher(grid, kCeres).match(points, kTruth);
  const ScanMatch b = CeresMatcher(grid, twice).match(points, kTruth);
  EXPECT_TRUE(b.covariance.isApprox(2.0 * a.covariance, 1e-9));
  EXPECT_TRUE(a.information.isApprox(2.0 * b.information, 1e-9));
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(a.covariance).eigenvalues().minCoeff(), 0.0);
  // Without what holds the guess, all that is known comes from the match.
  CeresScanMatcherParameters free = kCeres;
  free.previous_pose_translation_delta_cost_functor_weight = 0.0;
  free.initial_pose_estimate_rotation_delta_cost_functor_weight = 0.0;
  const ScanMatch c = CeresMatcher(grid, free).match(points, kTruth);
  EXPECT_TRUE((c.covariance * c.information).isIdentity(1e-3));
}

/// A straight wall says nothing of the position along it.
TEST(CeresMatcher, CovarianceIsWideAlongAWall) {
  ProbabilityGrid grid(GridLimits{0.025, -5.0, 0.0, 400, 100});
  std::vector<BeamEnd> ends;
  Points points;
  for (int k = -390; k <= 390; ++k) ends.push_back({{0.0125 * k, 1.01}, true});
  for (int k = -60; k <= 60; ++k) points.push_back({0.02 * k, 1.0});
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(BeamInserter(kFine).insert({0.0, 0.5}, ends, grid));
  const ScanMatch match = CeresMatcher(grid, kCeres).match(points, {0.0, 0.004, 0.0});
  EXPECT_GT(match.covariance(0, 0), 100.0 * match.covariance(1, 1));
  EXPECT_LT(match.information(0, 0), 1e-6 * match.information(1, 1));
}

TEST(Matchers, SayWhatTheyCannotUse) {
  const ProbabilityGrid grid = grid_of_room(kCoarse);
  const Pose2 broken{std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0};
  const CeresMatcher ceres(grid, kCeres);
  const CorrelativeMatcher correlative(grid, {});
  for (const ScanMatcher* matcher :
       {static_cast<const ScanMatcher*>(&ceres), static_cast<const ScanMatcher*>(&correlative)}) {
    EXPECT_THROW(matcher->match(seen_from(kTruth, 1), broken), InputError);
    const ScanMatch match = matcher->match({}, kTruth);
    EXPECT_EQ(match.rejection, Rejection::kGridEmptyScan);
    EXPECT_EQ(distance(match.pose, kTruth), 0.0);
  }
}

/// Central differences of a cost at a pose.
Eigen::MatrixXd numeric_jacobian(const ceres::CostFunction& cost, Eigen::Vector3d pose) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd jacobian(cost.num_residuals(), 3);
  for (int k = 0; k < 3; ++k) {
    Eigen::VectorXd plus(cost.num_residuals()), minus(cost.num_residuals());
    const double at = pose[k];
    const double* const block = pose.data();
    pose[k] = at + kStep;
    cost.Evaluate(&block, plus.data(), nullptr);
    pose[k] = at - kStep;
    cost.Evaluate(&block, minus.data(), nullptr);
    pose[k] = at;
    jacobian.col(k) = (plus - minus) / (2.0 * kStep);
  }
  return jacobian;
}

Eigen::MatrixXd analytic_jacobian(const ceres::CostFunction& cost, const Eigen::Vector3d& pose) {
  Eigen::VectorXd residuals(cost.num_residuals());
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> jacobian(cost.num_residuals(), 3);
  double* blocks[] = {jacobian.data()};
  const double* const block = pose.data();
  EXPECT_TRUE(cost.Evaluate(&block, residuals.data(), blocks));
  return jacobian;
}

TEST(MatchingCosts, JacobiansAreThoseOfTheResiduals) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    const ProbabilityGrid grid = random_grid(seed, 40, 30);
    const Points points = random_cloud(seed, 60, 1.0);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> offset(-1.0, 1.0);
    const Eigen::Vector3d pose(0.6 + 0.3 * offset(random), 1.4 + 0.3 * offset(random), kPi * offset(random));
    const OccupiedSpaceCost occupied(points, grid, 20.0);
    const Eigen::MatrixXd numeric = numeric_jacobian(occupied, pose);
    EXPECT_LT((analytic_jacobian(occupied, pose) - numeric).cwiseAbs().maxCoeff(),
              1e-4 * (1.0 + numeric.cwiseAbs().maxCoeff()));
    const DeltaCost delta({0.3, -0.2}, 0.7, 3.0, 40.0);
    EXPECT_TRUE(analytic_jacobian(delta, pose).isApprox(numeric_jacobian(delta, pose), 1e-6));
  }
}

TEST(MatchingCosts, InterpolationGoesThroughTheCentresOfCells) {
  const ProbabilityGrid grid = random_grid(3, 12, 9);
  const Points at_sensor{{0.0, 0.0}};
  const OccupiedSpaceCost cost(at_sensor, grid, 1.0);
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 12; ++column) {
      const double pose[] = {grid.limits().origin_x + 0.05 * (column + 0.5),
                             grid.limits().origin_y + 0.05 * (row + 0.5), 0.3};
      const double* const block = pose;
      double residual = 0.0;
      cost.Evaluate(&block, &residual, nullptr);
      EXPECT_NEAR(1.0 - residual, grid.probability(column, row), 1e-9);
    }
  }
}

}  // namespace
}  // namespace oort
