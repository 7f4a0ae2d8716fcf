// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "search.hpp"

namespace frsm {

/// Half widths that bound the polish about its start. [m, m, rad]
using Bounds = Window;

/// Climbs from a pose of the lattice to the maximum of  weight * mean M(T p) + log prior,  M interpolated: Levenberg's
/// method on the residuals sqrt(1 - M). Returns the start if nothing within the bounds is better.
Pose polish(const Table& table, const Points& body, const Objective& objective, const Pose& start,
            const Bounds& bounds);

/// What the score's shape about its peak tells of the pose, along the table's axes.
struct Shape {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< 0 along free directions
  int free_directions = 0;
  // Of the first free_directions columns each is a motion that no point resists, in cells; what tells how much of it is
  // in another motion; and how far the window goes along it, in cells.
  Eigen::Matrix3d free = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d free_dual = Eigen::Matrix3d::Zero();
  Eigen::Vector3d free_width = Eigen::Vector3d::Zero();

  /// Along free directions the information of a standard deviation as wide as the window, 0 elsewhere.
  Eigen::Matrix3d window_information() const;
};

/// Fits a quadratic to the scores of 5 x 5 x 5 poses about the peak, two cells each way and as far by turning.
/// Directions whose curvature is below `min_curvature` of what a wall seen by every point has are free.
Shape fit_shape(const Table& table, const Points& body, const Pose& peak, double weight, double min_curvature,
                const Window& window);

/// Moves a pose along its free directions to where the prior is best; without one, nearest to the guess. A direction in
/// which the score of a good match falls after all within some cells is free no longer: the pose stays there, and
/// `shape` has information along it.
Pose slide_to_prior(const Table& table, const Points& body, const Pose& pose, const Objective& objective,
                    const Pose& guess, Shape* shape);

}  // namespace frsm
