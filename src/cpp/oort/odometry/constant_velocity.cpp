// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/odometry/constant_velocity.hpp"

#include <algorithm>
#include <cmath>

#include "oort/odometry/tuning.hpp"

namespace oort {

ConstantVelocity::Prediction ConstantVelocity::predict(double time) {
  interval_ = last_time_ ? pace_.next(time - *last_time_) : 0.0;
  last_time_ = time;
  const bool is_timed = interval_ >= OdometryTuning::kMinInterval && moved_interval_ >= OdometryTuning::kMinInterval;
  const double ratio = is_timed ? std::min(interval_ / moved_interval_, OdometryTuning::kMaxRatio) : 1.0;
  Prediction prediction;
  prediction.T_before_after = {ratio * motion_.x, ratio * motion_.y, wrap_angle(ratio * motion_.theta)};
  // A change of velocity within the interval moves the base by a t^2 / 2.
  const double t = std::clamp(interval_, OdometryTuning::kMinInterval, OdometryTuning::kMaxInterval);
  const double xy = OdometryTuning::kPredictionError + 0.5 * OdometryTuning::kUsualAcceleration * t * t;
  const double theta = OdometryTuning::kPredictionErrorTheta + 0.5 * OdometryTuning::kUsualTurnAcceleration * t * t;
  prediction.covariance = Eigen::Vector3d(xy * xy, xy * xy, theta * theta).asDiagonal();
  return prediction;
}

void ConstantVelocity::moved(const Pose2& T_before_after, bool is_matched) {
  const double kept = is_matched ? 1.0 : OdometryTuning::kUnmatchedVelocity;
  motion_ = {kept * T_before_after.x, kept * T_before_after.y, kept * T_before_after.theta};
  moved_interval_ = interval_;
}

void ConstantVelocity::forget() {
  *this = ConstantVelocity();
}

}  // namespace oort
