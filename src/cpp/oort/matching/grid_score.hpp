// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "oort/geometry/points.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/grid/probability_grid.hpp"
#include "oort/matching/scan_matcher.hpp"

/// What the matchers on probability grids share.
namespace oort {

/// The column and row of a cell; may lie outside the grid.
using CellIndex = Eigen::Array2i;

/// The cells that points lie in, seen from a pose of the grid's frame.
std::vector<CellIndex> cells_of(const Points& points, const Pose2& T_grid_sensor, const GridLimits& limits);

/// The largest turn that moves no point by more than about a cell: acos(1 - r^2 / (2 d^2)) with the cell's side r and
/// the distance d of the farthest point (Hess et al. 2016, equation 7) [rad].
double angular_step(const Points& points, double resolution);

/// Mean probability of the cells that points lie in from a pose, and the share of them that are rather occupied than
/// free. Sets a match's score and inlier_ratio.
void score_pose(const ProbabilityGrid& grid, const Points& points, ScanMatch& match);

/// Covariance of a pose from the scores of poses around it (Olson 2009, equations 7 and 8), of which each counts
/// exp(n (score - best)), n being the number of points; with what a lattice of such steps leaves open added.
class SampleCovariance {
 public:
  SampleCovariance(double best_score, std::size_t points) : best_(best_score), points_(static_cast<double>(points)) {}

  /// `offset`: x, y, theta from the best pose.
  void add(const Eigen::Vector3d& offset, double score);

  /// `steps`: distances of the lattice in x, y, theta.
  Eigen::Matrix3d covariance(const Eigen::Vector3d& steps) const;

 private:
  double best_;
  double points_;
  double weight_ = 0.0;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d square_ = Eigen::Matrix3d::Zero();
};

/// Throws InputError if a guess is not finite or more than 1000 km off.
void check_guess(const Pose2& guess);

}  // namespace oort
