// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "refine.hpp"
#include "slice.hpp"

namespace frsm {
namespace {

constexpr int kReach = 2;             // cells and steps each way
constexpr double kSumSquare = 14.0;   // sum of (u^2 - 2)^2 over u = -2..2
constexpr double kSumProduct = 10.0;  // sum of u^2
constexpr double kSamples = 5.0;
// A slide to the prior may cost a scan this share of its score. Corridors lose 2 % (median on fr079, CSAIL and the
// sparse logs of Radish); a peak made blunt by a map whose scans disagree by a cell or two lost a third, and 4 degrees
// with it. A poor match is left to the prior all the same: it may be the wrong peak.
constexpr double kMaxSlideLoss = 0.2;
constexpr double kLeastHeldScore = 0.6;

// The scan turns about the middle of its points: about the sensor, turning and moving sideways would look alike.
struct Pivot {
  Point body;            // in the body frame
  double radius2 = 0.0;  // mean squared distance of the points from it
};

Pivot find_pivot(const Points& body) {
  Pivot pivot;
  const auto n = static_cast<double>(body.size());
  for (const Point& p : body) {
    pivot.body.x += p.x / n;
    pivot.body.y += p.y / n;
  }
  for (const Point& p : body) {
    pivot.radius2 += (std::pow(p.x - pivot.body.x, 2) + std::pow(p.y - pivot.body.y, 2)) / n;
  }
  return pivot;
}

// The pose that is turned by an angle about a point of the body.
Pose turn_about(const Pose& pose, const Point& pivot, double angle) {
  const Point fixed = pose * pivot;
  const Point moved = Pose{0.0, 0.0, pose.theta + angle} * pivot;
  return {fixed.x - moved.x, fixed.y - moved.y, pose.theta + angle};
}

// Hessian of the least-squares quadratic through the mean values per point, per cell^2 and step^2. On a symmetric grid
// the terms u^2 - 2 and u v are orthogonal to each other and to all lower ones, so each is one weighted sum.
Eigen::Matrix3d fit_hessian(const Table& table, const Points& body, const Pose& peak, const Point& pivot,
                            double theta_step) {
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Slice slice(kReach, kReach);
  std::vector<Cell> cells;
  for (int it = -kReach; it <= kReach; ++it) {
    to_cells(table, body, turn_about(peak, pivot, it * theta_step), &cells);
    slice.score(table.view(), cells);
    for (int iy = -kReach; iy <= kReach; ++iy) {
      for (int ix = -kReach; ix <= kReach; ++ix) {
        const std::array<double, 3> u{static_cast<double>(ix), static_cast<double>(iy), static_cast<double>(it)};
        const double score = slice.sum(ix, iy);
        for (int i = 0; i < 3; ++i) {
          hessian(i, i) += 2.0 * score * (u[i] * u[i] - 2.0) / (kSumSquare * kSamples * kSamples);
          for (int j = 0; j < i; ++j) hessian(i, j) += score * u[i] * u[j] / (kSumProduct * kSumProduct * kSamples);
        }
      }
    }
  }
  hessian = Eigen::Matrix3d(hessian.selfadjointView<Eigen::Lower>());
  return hessian / (255.0 * static_cast<double>(body.size()));
}

// The curvature, per cell^2, that a straight wall seen by every point gives across it.
double full_curvature(const TableParams& params) {
  double curvature = 0.0;
  for (int u = -kReach; u <= kReach; ++u) {
    curvature -= 2.0 * std::exp(-std::abs(u) * params.cell / params.sigma) * (u * u - 2.0) / kSumSquare;
  }
  return curvature;
}

double mean_score(const Table& table, const Points& body, const Pose& pose) {
  double sum = 0.0;
  for (const Point& p : transform(pose, body)) sum += table.value(table.index(p.x), table.index(p.y));
  return sum / (255.0 * static_cast<double>(body.size()));
}

}  // namespace

Shape fit_shape(const Table& table, const Points& body, const Pose& peak, double weight, double min_curvature,
                const Window& window) {
  const double cell = table.params().cell;
  const Pivot pivot = find_pivot(body);
  const double theta_step = cell / std::max(std::sqrt(pivot.radius2), cell);  // moves the points by about a cell
  const Eigen::Vector3d steps(cell, cell, theta_step);
  const Eigen::Vector3d widths(std::max(window.x, cell), std::max(window.y, cell), std::max(window.theta, theta_step));
  const Point lever = Pose{0.0, 0.0, peak.theta} * pivot.body;
  Eigen::Matrix3d to_pivot = Eigen::Matrix3d::Identity();  // motion of the pivot by that of the pose
  to_pivot(0, 2) = -lever.y;
  to_pivot(1, 2) = lever.x;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(-fit_hessian(table, body, peak, pivot.body, theta_step));
  Shape shape;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d direction = eigen.eigenvectors().col(i);  // in cells and steps
    const Eigen::Vector3d row = to_pivot.transpose() * direction.cwiseQuotient(steps);
    if (eigen.eigenvalues()[i] >= min_curvature * full_curvature(table.params())) {
      shape.information += weight * eigen.eigenvalues()[i] * row * row.transpose();
    } else {
      const double half_width = direction.cwiseProduct(widths.cwiseQuotient(steps)).norm();
      shape.window_information += row * row.transpose() / (half_width * half_width);
      shape.free_dual.col(shape.free_directions) = row;
      shape.free.col(shape.free_directions++) = to_pivot.inverse() * direction.cwiseProduct(steps);
    }
  }
  return shape;
}

Pose slide_to_prior(const Table& table, const Points& body, const Pose& pose, const Objective& objective,
                    const Pose& guess, Shape* shape) {
  if (shape->free_directions == 0) return pose;
  const auto& gaussian = objective.gaussian();
  const Pose& mean = gaussian ? gaussian->mean : guess;
  const Eigen::Matrix3d metric = gaussian ? objective.information() : shape->window_information;
  const auto free = shape->free.leftCols(shape->free_directions);
  const Eigen::Vector3d d(pose.x - mean.x, pose.y - mean.y, wrap(pose.theta - mean.theta));
  // min over t of (d + F t)^T M (d + F t)
  const Eigen::MatrixXd normal = free.transpose() * metric * free;
  const Eigen::VectorXd t = -normal.ldlt().solve(free.transpose() * metric * d);
  const Eigen::Vector3d slide = free * t;
  const Pose slid{pose.x + slide[0], pose.y + slide[1], wrap(pose.theta + slide[2])};
  const double here = mean_score(table, body, pose);
  const double loss = here - mean_score(table, body, slid);
  if (loss <= kMaxSlideLoss * here || here < kLeastHeldScore) return slid;
  const Eigen::Vector3d along = shape->free_dual.leftCols(shape->free_directions) * t / t.squaredNorm();
  shape->information += 2.0 * objective.weight() * loss * along * along.transpose();
  --shape->free_directions;
  return pose;
}

}  // namespace frsm
