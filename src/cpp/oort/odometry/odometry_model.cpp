// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/odometry/odometry_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "oort/odometry/tuning.hpp"

namespace oort {
namespace {

double square(double value) {
  return value * value;
}
}  // namespace

Eigen::Matrix3d OdometryModel::covariance(const Pose2& T_before_after) const {
  const double way = T_before_after.translation().norm();
  const double turn = std::abs(T_before_after.theta);
  const double translation =
      square(translation_per_meter) * way + square(translation_per_radian) * turn + square(translation_floor);
  const double rotation =
      square(rotation_per_meter) * way + square(rotation_per_radian) * turn + square(rotation_floor);
  return Eigen::Vector3d(translation, translation, rotation).asDiagonal();
}

LearnedOdometry::LearnedOdometry(const OdometryModel& model, double least)
    : model_(model),
      least_(least * least),
      steps_(OdometryTuning::kInitialSteps),
      ways_(OdometryTuning::kInitialTranslations),
      turns_(OdometryTuning::kInitialRotations) {}

Eigen::Matrix3d LearnedOdometry::covariance(const Pose2& T_before_after) const {
  Eigen::Matrix3d covariance = model_.covariance(T_before_after);
  covariance.topLeftCorner<2, 2>() *= translation_;
  covariance(2, 2) *= rotation_;
  return covariance;
}

void LearnedOdometry::learn(const Pose2& T_before_after, const Pose2& T_odometry_match) {
  if (least_ >= 1.0) return;
  const Eigen::Matrix3d expected = model_.covariance(T_before_after);
  const auto follow = [&](double& factor, double ratio) {
    factor += (std::min(ratio, OdometryTuning::kMaxVarianceRatio) - factor) / (steps_ + 1);
    factor = std::clamp(factor, least_, OdometryTuning::kMaxVarianceFactor);
  };
  follow(translation_, T_odometry_match.translation().squaredNorm() / expected.topLeftCorner<2, 2>().trace());
  follow(rotation_, square(T_odometry_match.theta) / expected(2, 2));
  steps_ = std::min(steps_ + 1, OdometryTuning::kMaxSteps);
  // Least squares of match = scale * measured, one step after the other.
  const Pose2 match = T_before_after * T_odometry_match;
  const auto fit = [](double& scale, double& sum, double most, double measured2, double ratio) {
    sum = std::min(sum + measured2, most);
    scale = std::clamp(scale + measured2 / sum * (ratio - 1.0) * scale, 1.0 - OdometryTuning::kMaxScaleError,
                       1.0 + OdometryTuning::kMaxScaleError);
  };
  const double way2 = T_before_after.translation().squaredNorm();
  if (std::abs(T_before_after.theta) < OdometryTuning::kStraight && way2 >= std::numeric_limits<double>::min()) {
    const double ratio = T_before_after.translation().dot(match.translation()) / way2;
    fit(way_scale_, ways_, OdometryTuning::kMaxTranslations, way2 / square(way_scale_),
        std::clamp(ratio, 1.0 - OdometryTuning::kMaxScaleError, 1.0 + OdometryTuning::kMaxScaleError));
  }
  if (square(T_before_after.theta) >= std::numeric_limits<double>::min()) {  // else the ratio may be no number
    const double ratio = 1.0 + T_odometry_match.theta / T_before_after.theta;
    fit(turn_scale_, turns_, OdometryTuning::kMaxRotations, square(T_before_after.theta / turn_scale_), ratio);
  }
}

Pose2 LearnedOdometry::corrected(const Pose2& T_before_after) const {
  return {way_scale_ * T_before_after.x, way_scale_ * T_before_after.y, turn_scale_ * T_before_after.theta};
}

}  // namespace oort
