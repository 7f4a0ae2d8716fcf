// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/surface_pieces.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstddef>
#include <optional>

#include "oort/geometry/tuning.hpp"
#include "oort/maintenance/tuning.hpp"

namespace oort {
namespace {

/// The straight line through some returns, if it is one.
std::optional<SurfacePiece> line_through(const std::vector<Eigen::Vector2d>& points) {
  if (points.size() < RefinementTuning::kMinPieceReturns) return std::nullopt;
  const double length = (points.back() - points.front()).norm();
  if (length < RefinementTuning::kMinPieceLength || length > RefinementTuning::kMaxPieceLength) return std::nullopt;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points) scatter += (p - mean) * (p - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
  eigen.computeDirect(scatter);
  if (eigen.eigenvalues()(0) >
      RefinementTuning::kMaxPieceThickness * RefinementTuning::kMaxPieceThickness * eigen.eigenvalues()(1)) {
    return std::nullopt;
  }
  Eigen::Vector2d normal = eigen.eigenvectors().col(0);
  if (normal.dot(mean) > 0.0) normal = -normal;  // the sensor is at the origin
  return SurfacePiece{mean, normal};
}

}  // namespace

std::vector<SurfacePiece> surface_pieces(const PointCloud& cloud) {
  std::vector<SurfacePiece> pieces;
  std::vector<Eigen::Vector2d> run;
  const auto end_piece = [&] {
    if (const std::optional<SurfacePiece> piece = line_through(run)) pieces.push_back(*piece);
    run.clear();
  };
  for (const Point2& point : cloud.points) {
    if (!point.is_return()) continue;
    const Eigen::Vector2d p(point.x, point.y);
    if (!run.empty() && (p - run.back()).norm() > GeometryTuning::kMaxSurfaceGap) end_piece();
    run.push_back(p);
    if (run.size() >= RefinementTuning::kMinPieceReturns &&
        (p - run.front()).norm() >= RefinementTuning::kPieceLength) {
      end_piece();
    }
  }
  end_piece();
  return pieces;
}

std::vector<SurfacePiece> transformed(const Pose2& T_a_b, const std::vector<SurfacePiece>& pieces_b) {
  const Eigen::Matrix2d R = rotation(T_a_b.theta);
  const Eigen::Vector2d t = T_a_b.translation();
  std::vector<SurfacePiece> pieces_a;
  pieces_a.reserve(pieces_b.size());
  for (const SurfacePiece& piece : pieces_b) pieces_a.push_back({R * piece.center + t, R * piece.normal});
  return pieces_a;
}

}  // namespace oort
