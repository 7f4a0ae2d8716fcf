// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>

#include "oort/geometry/pose2.hpp"

namespace oort {

/// How far odometry may be off after a motion: variances grow in proportion to translation and rotation, so that
/// cutting a motion into steps does not change the sum (Thrun, Burgard, Fox 2005, section 5.4).
struct OdometryModel {
  double translation_per_meter = 0.0;   ///< standard deviation of x and y after one metre [m]
  double translation_per_radian = 0.0;  ///< of x and y after turning one radian [m]
  double rotation_per_meter = 0.0;      ///< of theta after one metre [rad]
  double rotation_per_radian = 0.0;     ///< of theta after turning one radian [rad]
  double translation_floor = 0.0;       ///< of x and y of any motion, however small [m]
  double rotation_floor = 0.0;          ///< of theta of any motion [rad]

  /// Covariance of a measured motion T_before_after, along the axes of the frame before.
  Eigen::Matrix3d covariance(const Pose2& T_before_after) const;
};

/// The model with two factors on its variances, of x and y and of theta, that follow how far odometry is from matches
/// that see all directions: a good base is believed more, a bad one less. Deterministic; starts at the model's values.
class LearnedOdometry {
 public:
  /// least: of the factors, as standard deviation (0 to 1); 1: nothing is learned.
  LearnedOdometry(const OdometryModel& model, double least);

  /// Covariance of a measured motion T_before_after, along the axes of the frame before.
  Eigen::Matrix3d covariance(const Pose2& T_before_after) const;

  /// Takes a (corrected) motion by odometry and where the match found its end, seen from where odometry did.
  void learn(const Pose2& T_before_after, const Pose2& T_odometry_match);

  /// A measured motion with what odometry is always wrong by taken out: the scales of translation and rotation that
  /// matches found.
  Pose2 corrected(const Pose2& T_before_after) const;

  const OdometryModel& model() const { return model_; }

  /// How far the base really drives and turns, by the matches, where odometry says 1.
  double way_scale() const { return way_scale_; }
  double turn_scale() const { return turn_scale_; }

  /// The factors, as standard deviations.
  double translation_factor() const { return std::sqrt(translation_); }
  double rotation_factor() const { return std::sqrt(rotation_); }

 private:
  OdometryModel model_;
  double least_;  // of the factors on variances
  double translation_ = 1.0;
  double rotation_ = 1.0;
  int steps_;
  double way_scale_ = 1.0;
  double turn_scale_ = 1.0;
  double ways_;  // sum of the squares of what was measured, fading
  double turns_;
};

}  // namespace oort
