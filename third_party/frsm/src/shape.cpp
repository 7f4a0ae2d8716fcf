// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
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
// Walls that were drawn a cell or two apart make a blunt peak: within kReach nothing resists. So a free direction must
// cost a match no more than this share of its score on the first cells of its way to the prior. Only on the first, as
// farther on, along a corridor, points leave what was ever drawn. A poor match is left to the prior all the same: it
// may be the wrong peak. Chosen with belgioioso, acapulco and edmonton.
constexpr double kSlideTest = 8.0;  // [cells]
constexpr double kMaxSlideLoss = 0.15;
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

// How far along each free direction the prior is best: min over t of (d + F t)^T M (d + F t).
Eigen::VectorXd way_to_prior(const Pose& pose, const Shape& shape, const Objective& objective, const Pose& guess) {
  const auto& gaussian = objective.gaussian();
  const Pose& mean = gaussian ? gaussian->mean : guess;
  const Eigen::Matrix3d metric = gaussian ? objective.information() : shape.window_information();
  const auto free = shape.free.leftCols(shape.free_directions);
  const Eigen::Vector3d d(pose.x - mean.x, pose.y - mean.y, wrap(pose.theta - mean.theta));
  const Eigen::MatrixXd normal = free.transpose() * metric * free;
  return -normal.ldlt().solve(free.transpose() * metric * d);
}

Pose moved(const Pose& pose, const Eigen::Vector3d& by) {
  return {pose.x + by[0], pose.y + by[1], wrap(pose.theta + by[2])};
}

// Makes directions free no longer in which the score falls on the way to the prior.
void hold_what_resists(const Table& table, const Points& body, const Pose& pose, double weight,
                       const Eigen::VectorXd& way, Shape* shape) {
  const double here = mean_score(table, body, pose);
  if (here < kLeastHeldScore) return;
  int left = 0;
  for (int k = 0; k < shape->free_directions; ++k) {
    const double cells = std::clamp(way[k], -kSlideTest, kSlideTest);
    const double loss = here - mean_score(table, body, moved(pose, cells * shape->free.col(k)));
    if (loss > kMaxSlideLoss * here) {
      const Eigen::Vector3d dual = shape->free_dual.col(k);
      shape->information += 2.0 * weight * loss / (cells * cells) * dual * dual.transpose();
    } else {
      shape->free.col(left) = shape->free.col(k).eval();
      shape->free_dual.col(left) = shape->free_dual.col(k).eval();
      shape->free_width[left++] = shape->free_width[k];
    }
  }
  shape->free_directions = left;
}

}  // namespace

Eigen::Matrix3d Shape::window_information() const {
  Eigen::Matrix3d wide = Eigen::Matrix3d::Zero();
  for (int k = 0; k < free_directions; ++k) {
    wide += free_dual.col(k) * free_dual.col(k).transpose() / (free_width[k] * free_width[k]);
  }
  return wide;
}

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
      const int k = shape.free_directions++;
      shape.free.col(k) = to_pivot.inverse() * direction.cwiseProduct(steps);
      shape.free_dual.col(k) = row;
      shape.free_width[k] = direction.cwiseProduct(widths.cwiseQuotient(steps)).norm();
    }
  }
  return shape;
}

Pose slide_to_prior(const Table& table, const Points& body, const Pose& pose, const Objective& objective,
                    const Pose& guess, Shape* shape) {
  if (shape->free_directions == 0) return pose;
  const Eigen::VectorXd way = way_to_prior(pose, *shape, objective, guess);
  hold_what_resists(table, body, pose, objective.weight(), way, shape);
  if (shape->free_directions == 0) return pose;
  const Eigen::VectorXd rest =
      shape->free_directions == way.size() ? way : way_to_prior(pose, *shape, objective, guess);
  return moved(pose, shape->free.leftCols(shape->free_directions) * rest);
}

}  // namespace frsm
