// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/matching/ceres_matcher.hpp"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/LU>
#include <vector>

#include "oort/matching/grid_score.hpp"
#include "oort/matching/internal/matching_costs.hpp"
#include "oort/matching/tuning.hpp"

namespace oort {
namespace {

ceres::Solver::Options solver_options(const CeresSolverParameters& parameters) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.use_nonmonotonic_steps = parameters.use_nonmonotonic_steps;
  options.max_num_iterations = parameters.max_num_iterations;
  options.num_threads = parameters.num_threads;
  options.logging_type = ceres::SILENT;
  return options;
}

/// J^T J of one term at a pose.
Eigen::Matrix3d normal_matrix(const ceres::CostFunction& cost, const double* pose) {
  Eigen::VectorXd residuals(cost.num_residuals());
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> jacobian(cost.num_residuals(), 3);
  double* blocks[] = {jacobian.data()};
  cost.Evaluate(&pose, residuals.data(), blocks);
  return jacobian.transpose() * jacobian;
}

}  // namespace

ScanMatch CeresMatcher::match(const Points& points, const Pose2& guess, const Eigen::Vector2d& target) const {
  check_guess(guess);
  ScanMatch match;
  match.pose = guess;
  if (points.empty()) return match;
  const CeresScanMatcherParameters& p = parameters_;
  OccupiedSpaceCost occupied(points, grid_, p.occupied_space_cost_functor_weight);
  DeltaCost delta(target, guess.theta, p.previous_pose_translation_delta_cost_functor_weight,
                  p.initial_pose_estimate_rotation_delta_cost_functor_weight);
  double pose[] = {guess.x, guess.y, guess.theta};
  ceres::Problem::Options borrowing;
  borrowing.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(borrowing);
  problem.AddResidualBlock(&occupied, nullptr, pose);
  problem.AddResidualBlock(&delta, nullptr, pose);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(p.ceres_solver_options), &problem, &summary);

  match.rejection = Rejection::kNone;
  match.evaluations = summary.num_successful_steps + summary.num_unsuccessful_steps;
  match.pose = {pose[0], pose[1], wrap_angle(pose[2])};
  score_pose(grid_, points, match);
  const Eigen::Matrix3d seen = normal_matrix(occupied, pose);
  const Eigen::Matrix3d held =
      seen + normal_matrix(delta, pose) + MatchingTuning::kMinInformation * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d inverse = held.inverse();
  match.information = seen / p.covariance_scale;
  match.covariance = 0.5 * p.covariance_scale * (inverse + inverse.transpose());
  return match;
}

}  // namespace oort
