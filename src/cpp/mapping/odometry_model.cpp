// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapping/odometry_model.hpp"

#include <algorithm>
#include <cmath>

namespace oort {
namespace {
// The model counts as so many steps at first, and the newest step as one of so many later on.
constexpr int kFirstSteps = 10;
constexpr int kMostSteps = 100;

// A single step says no more than this about the variance: a slip of the wheels is not how they always are.
constexpr double kMostRatio = 25.0;
constexpr double kMostFactor = 9.0;  // on variances

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
    : model_(model), least_(least * least), steps_(kFirstSteps) {}

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
    factor += (std::min(ratio, kMostRatio) - factor) / (steps_ + 1);
    factor = std::clamp(factor, least_, kMostFactor);
  };
  follow(translation_, T_odometry_match.translation().squaredNorm() / expected.topLeftCorner<2, 2>().trace());
  follow(rotation_, square(T_odometry_match.theta) / expected(2, 2));
  steps_ = std::min(steps_ + 1, kMostSteps);
}

}  // namespace oort
