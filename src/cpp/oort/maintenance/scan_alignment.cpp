// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/scan_alignment.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "oort/maintenance/tuning.hpp"

namespace oort {
namespace {

/// The nearest piece of the same surface, if there is one.
const SurfacePiece* counterpart(const SurfacePiece& piece, const std::vector<SurfacePiece>& others,
                                double max_distance) {
  const SurfacePiece* best = nullptr;
  double least = max_distance * max_distance + RefinementTuning::kMaxAlong * RefinementTuning::kMaxAlong;
  for (const SurfacePiece& other : others) {
    const Eigen::Vector2d d = piece.center - other.center;
    const double distance = d.squaredNorm();
    if (distance >= least || other.normal.dot(piece.normal) < RefinementTuning::kMinCosine) continue;
    if (std::abs(other.normal.dot(d)) > max_distance) continue;
    least = distance;
    best = &other;
  }
  return best;
}

}  // namespace

ScanAlignment align(const std::vector<SurfacePiece>& pieces_i, const std::vector<SurfacePiece>& pieces_j,
                    const Pose2& T_i_j, double max_distance) {
  ScanAlignment result;
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (const SurfacePiece& piece : transformed(T_i_j, pieces_j)) {
    const SurfacePiece* other = counterpart(piece, pieces_i, max_distance);
    if (other == nullptr) continue;
    const Eigen::Vector2d n = (other->normal + piece.normal).normalized();
    const double e = n.dot(piece.center - other->center);
    const Eigen::Vector2d arm = piece.center - T_i_j.translation();
    const Eigen::Vector3d J(n.x(), n.y(), n.y() * arm.x() - n.x() * arm.y());
    const double near = 1.0 / (1.0 + (e / RefinementTuning::kRobustScale) * (e / RefinementTuning::kRobustScale));
    const double w = near * near;
    H += w * J * J.transpose();
    gradient += w * e * J;
    ++result.pairs;
    result.weight += w;
    result.squared_distance += w * e * e;
  }
  if (result.pairs == 0) return result;
  result.share = std::min(
      1.0, static_cast<double>(result.pairs) / static_cast<double>(std::min(pieces_i.size(), pieces_j.size())));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(H);
  for (int k = 0; k < 3; ++k) {
    const double curvature = eigen.eigenvalues()(k);
    if (curvature < RefinementTuning::kMinCurvature * result.weight) continue;
    const Eigen::Vector3d v = eigen.eigenvectors().col(k);
    result.correction -= v * (v.dot(gradient) / curvature);
    result.W.row(k) =
        std::sqrt(RefinementTuning::kInformationShare * curvature) / RefinementTuning::kPieceSigma * v.transpose();
  }
  return result;
}

}  // namespace oort
