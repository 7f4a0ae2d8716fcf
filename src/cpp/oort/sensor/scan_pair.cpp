// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/sensor/scan_pair.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "oort/geometry/tuning.hpp"
#include "oort/sensor/tuning.hpp"

namespace oort {
namespace {

std::vector<Eigen::Vector2d> thinned_returns(const PointCloud& cloud) {
  const std::size_t stride = count_returns(cloud) / SensorTuning::kMaxAlignedPoints + 1;
  std::vector<Eigen::Vector2d> points;
  std::size_t k = 0;
  for (const Point2& p : cloud.points) {
    if (p.is_return() && k++ % stride == 0) points.emplace_back(p.x, p.y);
  }
  return points;
}

}  // namespace

ReferenceScan::ReferenceScan(const PointCloud& cloud) {
  std::vector<Eigen::Vector2d> points;
  for (const Point2& p : cloud.points) {
    if (p.is_return()) points.emplace_back(p.x, p.y);
  }
  const auto is_near = [&](std::size_t a, std::size_t b) {
    return (points[a] - points[b]).norm() < GeometryTuning::kMaxSurfaceGap;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t before = i > 0 && is_near(i - 1, i) ? i - 1 : i;
    const std::size_t after = i + 1 < points.size() && is_near(i, i + 1) ? i + 1 : i;
    const Eigen::Vector2d along = points[after] - points[before];
    if (along.norm() == 0.0) continue;
    surfaces_.push_back({points[i], Eigen::Vector2d(-along.y(), along.x()).normalized()});
  }
}

bool ReferenceScan::is_usable() const {
  return surfaces_.size() >= SensorTuning::kMinAlignedPoints;
}

const ReferenceScan::Surface* ReferenceScan::nearest(const Eigen::Vector2d& point, double reach) const {
  const Surface* best = nullptr;
  double least = reach * reach;
  for (const Surface& surface : surfaces_) {
    const double distance = (surface.point - point).squaredNorm();
    if (distance < least) {
      least = distance;
      best = &surface;
    }
  }
  return best;
}

PairMatch ReferenceScan::align(const PointCloud& scan, const Pose2& guess) const {
  const std::vector<Eigen::Vector2d> points = thinned_returns(scan);
  PairMatch match;
  match.T_reference_scan = guess;
  match.cost = SensorTuning::kLastReach * SensorTuning::kLastReach;
  if (points.size() < SensorTuning::kMinAlignedPoints || !is_usable()) return match;
  Pose2& T = match.T_reference_scan;
  for (int step = 0; step < SensorTuning::kAlignmentSteps; ++step) {
    const double part = std::min(1.0, 2.0 * step / SensorTuning::kAlignmentSteps);
    const double reach = SensorTuning::kFirstReach + part * (SensorTuning::kLastReach - SensorTuning::kFirstReach);
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    double cost = 0.0;
    std::size_t partners = 0;
    for (const Eigen::Vector2d& p : points) {
      const Eigen::Vector2d q = T * p;
      const Surface* surface = nearest(q, reach);
      const double error = surface ? surface->normal.dot(q - surface->point) : SensorTuning::kLastReach;
      cost += std::min(error * error, SensorTuning::kLastReach * SensorTuning::kLastReach);
      if (!surface) continue;
      ++partners;
      // Of the error by a small motion x, y, theta about the reference's origin after T.
      const Eigen::Vector3d J(surface->normal.x(), surface->normal.y(),
                              surface->normal.y() * q.x() - surface->normal.x() * q.y());
      information += J * J.transpose();
      gradient += J * error;
    }
    match.cost = cost / static_cast<double>(points.size());
    match.inlier_ratio = static_cast<double>(partners) / static_cast<double>(points.size());
    if (partners < SensorTuning::kMinAlignedPoints) {
      match.degenerate = true;
      return match;
    }
    const Eigen::Matrix3d mean = information / static_cast<double>(partners);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(Eigen::Matrix2d(mean.topLeftCorner<2, 2>()));
    match.degenerate = axes.eigenvalues()(0) < SensorTuning::kMinEigenvalue;
    // A little damping leaves an open direction where the guess has it.
    const Eigen::Vector3d change = -(mean + 1e-4 * Eigen::Matrix3d::Identity()).ldlt().solve(gradient / partners);
    T = Pose2{change.x(), change.y(), change.z()} * T;
    if (part == 1.0 && change.cwiseAbs().maxCoeff() < SensorTuning::kConverged) break;
  }
  return match;
}

}  // namespace oort
