// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/matching/grid_score.hpp"

#include <algorithm>
#include <cmath>

#include "oort/geometry/errors.hpp"
#include "oort/matching/tuning.hpp"

namespace oort {
namespace {

constexpr double kNegligible = -40.0;  // e to this is below the precision of the sums
constexpr double kFarthest = 1e6;      // [m]; cells are counted with int

}  // namespace

std::vector<CellIndex> cells_of(const Points& points, const Pose2& T_grid_sensor, const GridLimits& limits) {
  const Eigen::Matrix2d R = rotation(T_grid_sensor.theta) / limits.resolution;
  const Eigen::Vector2d t = limits.to_cells(T_grid_sensor.translation());
  std::vector<CellIndex> cells;
  cells.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    cells.push_back((R * point + t).array().floor().cast<int>());
  }
  return cells;
}

double angular_step(const Points& points, double resolution) {
  double farthest = MatchingTuning::kNearestCells * resolution;
  for (const Eigen::Vector2d& point : points) farthest = std::max(farthest, point.norm());
  return std::acos(1.0 - resolution * resolution / (2.0 * farthest * farthest));
}

void score_pose(const ProbabilityGrid& grid, const Points& points, ScanMatch& match) {
  double sum = 0.0;
  std::size_t hits = 0;
  for (const CellIndex& cell : cells_of(points, match.pose, grid.limits())) {
    const double probability = grid.probability(cell.x(), cell.y());
    sum += probability;
    if (probability > MatchingTuning::kOccupied) ++hits;
  }
  match.score = sum / static_cast<double>(points.size());
  match.inlier_ratio = static_cast<double>(hits) / static_cast<double>(points.size());
}

void SampleCovariance::add(const Eigen::Vector3d& offset, double score) {
  const double exponent = points_ * (score - best_);
  if (exponent < kNegligible) return;
  const double weight = std::exp(exponent);
  weight_ += weight;
  mean_ += weight * offset;
  square_ += weight * offset * offset.transpose();
}

Eigen::Matrix3d SampleCovariance::covariance(const Eigen::Vector3d& steps) const {
  const Eigen::Vector3d mean = mean_ / weight_;
  const Eigen::Matrix3d lattice = (steps.cwiseAbs2() / 12.0).asDiagonal();
  return square_ / weight_ - mean * mean.transpose() + lattice;
}

void check_guess(const Pose2& guess) {
  if (!is_finite(guess) || std::max(std::abs(guess.x), std::abs(guess.y)) > kFarthest) {
    throw InputError("scan matcher: the guess is not finite or too far off; check where it comes from");
  }
}

}  // namespace oort
