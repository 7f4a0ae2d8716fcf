// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "oort/geometry/pose2.hpp"
#include "oort/maintenance/surface_pieces.hpp"

namespace oort {

/// What two scans that saw the same surfaces say of where one is from the other. For the pieces paired, with the
/// normal n of both, a pair's distance across the surface is e = n . (T_i_j c_j - c_i), and J = de/dT_i_j:
///
///   H = sum w J^T J,   correction = -H^+ sum w J^T e,   W^T W = kShare / kSigma^2 H,   w = 1 / (1 + (e / kRobust)^2)^2
///
/// (point to line, Chen and Medioni 1992, with the normal of both, Rusinkiewicz 2019; weights of Geman and McClure).
/// Directions in which H is small (along a corridor) are taken out of H: they are neither corrected nor weighted.
struct ScanAlignment {
  int pairs = 0;       ///< of pieces on the same surface
  double share = 0.0;  ///< of the pieces of the scan that has fewer: those paired, in [0, 1]
  Eigen::Vector3d correction = Eigen::Vector3d::Zero();  ///< of T_i_j: x, y along the axes of i [m], and theta [rad]
  Eigen::Matrix3d W = Eigen::Matrix3d::Zero();           ///< whitening matrix; rows of 0 for what the scans do not say
  double weight = 0.0;                                   ///< sum of w
  double squared_distance = 0.0;                         ///< sum of w e^2 [m^2]
};

/// Compares two scans at an estimate of T_i_j. Pieces are paired with the nearest that faces the same way, within
/// `max_distance` [m] across the surface. One step: to be asked again at the corrected pose.
ScanAlignment align(const std::vector<SurfacePiece>& pieces_i, const std::vector<SurfacePiece>& pieces_j,
                    const Pose2& T_i_j, double max_distance);

}  // namespace oort
