// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/odometry/gyro_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/odometry/tuning.hpp"

namespace oort {

void GyroOdometry::add_gyro(double time, double yaw_rate) {
  if (!std::isfinite(time) || !std::isfinite(yaw_rate)) {
    throw InputError("gyro: a time or yaw rate is not a finite number; check what publishes the IMU's messages");
  }
  if (!rates_.empty() && time <= rates_.back().time) {
    if (time >= rates_.back().time - OdometryTuning::kSetBack) return;
    rates_.clear();  // or they would shut out all that comes
  }
  rates_.push_back({time, yaw_rate});
  while (rates_.front().time < time - OdometryTuning::kKeptRates) rates_.pop_front();
  settle();
}

void GyroOdometry::add_odometry(double time, const Pose2& T_odom_base) {
  if (!std::isfinite(time) || !is_finite(T_odom_base)) {
    throw InputError("odometry: a time or pose is not a finite number; check what publishes odom -> base");
  }
  if (time <= newest_odometry_) return;
  newest_odometry_ = time;
  waiting_.push_back({time, T_odom_base});
  settle();
}

std::vector<TimedPose> GyroOdometry::take() {
  return std::exchange(settled_, {});
}

void GyroOdometry::flush() {
  for (const TimedPose& pose : waiting_) step(pose);
  waiting_.clear();
}

void GyroOdometry::set_back(double time) {
  flush();
  settled_.clear();
  newest_odometry_ = -std::numeric_limits<double>::infinity();
  if (!rates_.empty() && rates_.back().time > time + OdometryTuning::kSetBack) rates_.clear();
}

std::optional<double> GyroOdometry::bias() const {
  return learned_ >= OdometryTuning::kMinLearned ? std::make_optional(bias_) : std::nullopt;
}

void GyroOdometry::settle() {
  while (!waiting_.empty()) {
    const double time = waiting_.front().time;
    const bool is_covered = !rates_.empty() && rates_.back().time >= time;
    if (!is_covered && newest_odometry_ <= time + OdometryTuning::kPatience) return;
    step(waiting_.front());
    waiting_.pop_front();
  }
}

void GyroOdometry::step(const TimedPose& now) {
  if (!last_) {
    pose_ = now.pose;
  } else if (now.time <= last_->time) {  // the clock was set back
    pose_ = pose_ * between(last_->pose, now.pose);
    still_ = 0.0;
  } else {
    Pose2 motion = between(last_->pose, now.pose);
    const double duration = now.time - last_->time;
    const bool is_still = motion.translation().norm() <= OdometryTuning::kStandingSpeed * duration &&
                          std::abs(motion.theta) <= OdometryTuning::kStandingTurn * duration;
    still_ = is_still ? still_ + duration : 0.0;
    const std::optional<double> turn = integral(last_->time, now.time);
    if (turn && still_ > OdometryTuning::kSettling) learn_bias(*turn / duration, duration);
    const bool is_dead = is_silent(turn, motion.theta, duration);
    const bool is_used = turn && bias() && !is_dead &&
                         !(is_still && std::abs(*turn / duration - bias_) <= OdometryTuning::kMaxBiasChange);
    if (is_used) {
      const double correction = wrap_angle(*turn - bias_ * duration - motion.theta);
      const Eigen::Vector2d way = rotation(0.5 * correction) * motion.translation();  // the chord of the other arc
      motion = {way.x(), way.y(), wrap_angle(motion.theta + correction)};
    }
    ++(turn && bias() && !is_dead ? steps_by_gyro_ : steps_by_odometry_);
    pose_ = pose_ * motion;
  }
  last_ = now;
  settled_.push_back({now.time, pose_});
}

bool GyroOdometry::is_silent(const std::optional<double>& turn, double told_by_odometry, double duration) {
  if (std::abs(told_by_odometry) <= OdometryTuning::kMaxBiasChange * duration) return silent_ >= OdometryTuning::kDead;
  const bool says_nothing = turn && std::abs(*turn - bias_ * duration) <= OdometryTuning::kNoTurn * duration;
  silent_ = says_nothing ? silent_ + duration : 0.0;
  return silent_ >= OdometryTuning::kDead;
}

// A mean over the time that the base stood, the latest minute of it.
void GyroOdometry::learn_bias(double mean_rate, double duration) {
  const bool is_contrary =
      std::abs(mean_rate - bias_) > (bias() ? OdometryTuning::kMaxBiasChange : OdometryTuning::kMaxBias);
  if (is_contrary && std::abs(mean_rate - contrary_) <= OdometryTuning::kEvenness &&
      std::abs(mean_rate) <= OdometryTuning::kMaxBias) {
    contrary_for_ += duration;
    contrary_ += (mean_rate - contrary_) * std::min(1.0, duration / contrary_for_);
    if (contrary_for_ < OdometryTuning::kRelearning) return;
    bias_ = contrary_;
    learned_ = std::exchange(contrary_for_, 0.0);
    return;
  }
  contrary_ = mean_rate;
  contrary_for_ = 0.0;
  if (is_contrary) return;
  learned_ = std::min(learned_ + duration, OdometryTuning::kMaxLearned);
  bias_ += (mean_rate - bias_) * std::min(1.0, duration / learned_);
}

// The rate goes along a straight line between two samples.
std::optional<double> GyroOdometry::integral(double begin, double end) {
  while (rates_.size() > 1 && rates_[1].time <= begin) rates_.pop_front();
  if (rates_.empty() || rates_.front().time > begin || rates_.back().time < end) return std::nullopt;
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < rates_.size() && rates_[i].time < end; ++i) {
    const Rate& a = rates_[i];
    const Rate& b = rates_[i + 1];
    const double span = b.time - a.time;
    if (span > OdometryTuning::kMaxRateGap) return std::nullopt;
    const double from = std::max(a.time, begin);
    const double to = std::min(b.time, end);
    const auto at = [&](double t) { return a.value + (b.value - a.value) * (t - a.time) / span; };
    sum += 0.5 * (at(from) + at(to)) * (to - from);
  }
  return sum;
}

}  // namespace oort
