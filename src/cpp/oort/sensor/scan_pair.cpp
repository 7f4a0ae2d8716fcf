// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/sensor/scan_pair.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "oort/geometry/tuning.hpp"
#include "oort/sensor/tuning.hpp"

namespace oort {
namespace {

constexpr double kWorst = SensorTuning::kLastReach * SensorTuning::kLastReach;  // squared distance that counts [m^2]

std::vector<Eigen::Vector2d> thinned_returns(const PointCloud& cloud, std::size_t most) {
  const std::size_t stride = count_returns(cloud) / most + 1;
  std::vector<Eigen::Vector2d> points;
  std::size_t k = 0;
  for (const Point2& p : cloud.points) {
    if (p.is_return() && k++ % stride == 0) points.emplace_back(p.x, p.y);
  }
  return points;
}

PairMatch unmatched(const Pose2& guess) {
  return {guess, kWorst, kWorst, 0.0, true};
}

constexpr std::size_t kBins = 180;  // of bearing, in which surfaces are looked up

long bin_of(double bearing) {
  return static_cast<long>(std::floor(bearing * (kBins / (2.0 * M_PI))));
}

long wrapped(long bin) {
  const long bins = kBins;
  return ((bin % bins) + bins) % bins;
}

// Far away, neighbouring beams are farther apart than surfaces are from one another near by: there they see one if the
// line through them is not too steep for their beams.
bool are_on_one_surface(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  if ((a - b).norm() < GeometryTuning::kMaxSurfaceGap) return true;
  const double ranges = a.norm() * b.norm();
  const double step = std::abs(a.x() * b.y() - a.y() * b.x());
  return step < SensorTuning::kMaxBeamStep * ranges && a.dot(b) > 0.0 &&
         std::abs(a.norm() - b.norm()) * std::max(a.norm(), b.norm()) < SensorTuning::kMaxBeamSlope * step;
}

}  // namespace

ReferenceScan::ReferenceScan(const PointCloud& cloud) {
  std::vector<Eigen::Vector2d> points;
  for (const Point2& p : cloud.points) {
    if (p.is_return()) points.emplace_back(p.x, p.y);
  }
  const auto is_near = [&](std::size_t a, std::size_t b) { return are_on_one_surface(points[a], points[b]); };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t before = i > 0 && is_near(i - 1, i) ? i - 1 : i;
    const std::size_t after = i + 1 < points.size() && is_near(i, i + 1) ? i + 1 : i;
    const Eigen::Vector2d along = points[after] - points[before];
    if (along.norm() == 0.0) continue;
    surfaces_.push_back({points[i], Eigen::Vector2d(-along.y(), along.x()).normalized(),
                         0.5 * (points[i] - points[before]).norm(), 0.5 * (points[after] - points[i]).norm()});
  }
  sort_by_bearing();
}

void ReferenceScan::sort_by_bearing() {
  std::vector<std::pair<long, std::uint32_t>> seen;
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    const Surface& surface = surfaces_[k];
    const Eigen::Vector2d along(surface.normal.y(), -surface.normal.x());
    const Eigen::Vector2d begin = surface.point - surface.before * along;
    const Eigen::Vector2d end = surface.point + surface.after * along;
    const double from = std::atan2(begin.y(), begin.x());
    const double width = std::atan2(begin.x() * end.y() - begin.y() * end.x(), begin.dot(end));
    for (long bin = bin_of(std::min(from, from + width)); bin <= bin_of(std::max(from, from + width)); ++bin) {
      seen.emplace_back(wrapped(bin), static_cast<std::uint32_t>(k));
    }
  }
  std::sort(seen.begin(), seen.end());
  bins_.assign(kBins + 1, 0);
  by_bearing_.reserve(seen.size());
  for (const auto& [bin, surface] : seen) {
    by_bearing_.push_back(surface);
    ++bins_[static_cast<std::size_t>(bin) + 1];
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) bins_[bin + 1] += bins_[bin];
}

bool ReferenceScan::is_usable() const {
  return surfaces_.size() >= SensorTuning::kMinAlignedPoints;
}

const ReferenceScan::Surface* ReferenceScan::nearest(const Eigen::Vector2d& point, double reach) const {
  const double range = point.norm();
  // All that is within reach is seen at most so far beside the point.
  const double aside = range > reach ? std::asin(reach / range) : M_PI;
  const double bearing = std::atan2(point.y(), point.x());
  const long first = bin_of(bearing - aside);
  const long last = std::min(bin_of(bearing + aside), first + static_cast<long>(kBins) - 1);
  const Surface* best = nullptr;
  double least = reach * reach;
  for (long bin = first; bin <= last; ++bin) {
    const auto here = static_cast<std::size_t>(wrapped(bin));
    for (std::size_t k = bins_[here]; k < bins_[here + 1]; ++k) {
      const Surface& surface = surfaces_[by_bearing_[k]];
      const Eigen::Vector2d away = point - surface.point;
      const double across = surface.normal.dot(away);
      const double along = surface.normal.y() * away.x() - surface.normal.x() * away.y();
      const double beyond = std::max({0.0, along - surface.after, -along - surface.before});
      const double distance = across * across + beyond * beyond;
      if (distance < least) {
        least = distance;
        best = &surface;
      }
    }
  }
  return best;
}

bool ReferenceScan::can_align(const std::vector<Eigen::Vector2d>& points) const {
  return points.size() >= SensorTuning::kMinAlignedPoints && is_usable();
}

PairMatch ReferenceScan::align(const PointCloud& scan, const Pose2& guess, std::size_t max_points) const {
  const std::vector<Eigen::Vector2d> points = thinned_returns(scan, max_points);
  PairMatch match = unmatched(guess);
  if (!can_align(points)) return match;
  for (int step = 0; step < SensorTuning::kAlignmentSteps && improve(points, step, &match); ++step) {
  }
  return match;
}

PairMatch ReferenceScan::align_best(const PointCloud& scan, const std::vector<Pose2>& guesses,
                                    std::size_t max_points) const {
  const std::vector<Eigen::Vector2d> points = thinned_returns(scan, max_points);
  PairMatch best = unmatched(guesses.at(0));
  if (!can_align(points)) return best;
  const int half = SensorTuning::kAlignmentSteps / 2 + 1;
  bool goes_on = false;
  for (const Pose2& guess : guesses) {
    PairMatch match = unmatched(guess);
    bool went_on = true;
    for (int step = 0; step < half && went_on; ++step) went_on = improve(points, step, &match);
    if (&guess != &guesses.front() && match.cost >= best.cost) continue;
    best = match;
    goes_on = went_on;
  }
  for (int step = half; step < SensorTuning::kAlignmentSteps && goes_on; ++step) goes_on = improve(points, step, &best);
  return best;
}

// One step towards the surfaces; whether more are worth while.
bool ReferenceScan::improve(const std::vector<Eigen::Vector2d>& points, int step, PairMatch* match) const {
  Pose2& T = match->T_reference_scan;
  const double part = std::min(1.0, 2.0 * step / SensorTuning::kAlignmentSteps);
  const double reach = SensorTuning::kFirstReach + part * (SensorTuning::kLastReach - SensorTuning::kFirstReach);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double misfit = 0.0;
  std::size_t partners = 0;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d q = T * p;
    const Surface* surface = nearest(q, reach);
    if (!surface) continue;
    const double error = surface->normal.dot(q - surface->point);
    misfit += std::min(error * error, kWorst);
    ++partners;
    // Of the error by a small motion x, y, theta about the reference's origin after T.
    const Eigen::Vector3d J(surface->normal.x(), surface->normal.y(),
                            surface->normal.y() * q.x() - surface->normal.x() * q.y());
    information += J * J.transpose();
    gradient += J * error;
  }
  const auto count = static_cast<double>(points.size());
  match->cost = (misfit + kWorst * static_cast<double>(points.size() - partners)) / count;
  match->misfit = misfit / static_cast<double>(std::max<std::size_t>(partners, 1));
  match->inlier_ratio = static_cast<double>(partners) / count;
  if (partners < SensorTuning::kMinAlignedPoints) {
    match->degenerate = true;
    return false;
  }
  const Eigen::Matrix3d mean = information / static_cast<double>(partners);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(Eigen::Matrix2d(mean.topLeftCorner<2, 2>()));
  match->degenerate = axes.eigenvalues()(0) < SensorTuning::kMinEigenvalue;
  // A little damping leaves an open direction where the guess has it.
  const Eigen::Vector3d change = -(mean + 1e-4 * Eigen::Matrix3d::Identity()).ldlt().solve(gradient / partners);
  T = Pose2{change.x(), change.y(), change.z()} * T;
  return part < 1.0 || change.cwiseAbs().maxCoeff() >= SensorTuning::kConverged;
}

}  // namespace oort
