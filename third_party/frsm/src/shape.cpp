// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>

#include "refine.hpp"
#include "slice.hpp"

namespace frsm {
namespace {

constexpr int kReach = 2;              // cells and steps each way
constexpr double kSumSquare = 14.0;    // sum of (u^2 - 2)^2 over u = -2..2
constexpr double kSumProduct = 10.0;   // sum of u^2
constexpr double kSamples = 5.0;

double rms_range(const Points& body) {
  double sum = 0.0;
  for (const Point& p : body) sum += p.x * p.x + p.y * p.y;
  return std::sqrt(sum / static_cast<double>(body.size()));
}

// Hessian of the least-squares quadratic through the mean values per point, per cell^2 and step^2. On a symmetric grid
// the terms u^2 - 2 and u v are orthogonal to each other and to all lower ones, so each is one weighted sum.
Eigen::Matrix3d fit_hessian(const Table& table, const Points& body, const Pose& peak, double theta_step) {
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Slice slice(kReach, kReach);
  std::vector<Cell> cells;
  for (int it = -kReach; it <= kReach; ++it) {
    to_cells(table, body, {peak.x, peak.y, peak.theta + it * theta_step}, &cells);
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

}  // namespace

Shape fit_shape(const Table& table, const Points& body, const Pose& peak, double weight, double min_curvature,
                const Window& window) {
  const double cell = table.params().cell;
  const double theta_step = cell / std::max(rms_range(body), cell);  // moves the points by about a cell
  const Eigen::Vector3d steps(cell, cell, theta_step);
  const Eigen::Vector3d widths(std::max(window.x, cell), std::max(window.y, cell), std::max(window.theta, theta_step));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(-fit_hessian(table, body, peak, theta_step));
  Shape shape;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d direction = eigen.eigenvectors().col(i);  // in cells and steps
    const Eigen::Vector3d row = direction.cwiseQuotient(steps);
    if (eigen.eigenvalues()[i] >= min_curvature * full_curvature(table.params())) {
      shape.information += weight * eigen.eigenvalues()[i] * row * row.transpose();
    } else {
      const double half_width = direction.cwiseProduct(widths.cwiseQuotient(steps)).norm();
      shape.window_information += row * row.transpose() / (half_width * half_width);
      shape.degenerate = true;
    }
  }
  return shape;
}

}  // namespace frsm
