// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/odometry/gyro_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

constexpr double kPatience = 1.0;  // [s] that odometry waits for a gyro that is behind
constexpr double kSetBack = 1.0;   // [s] by which a message is older than the last where the clock was set back
constexpr double kKept = 20.0;     // [s] of rates that are kept while no odometry comes
constexpr double kMostGap = 0.1;   // [s] between two rates; over a longer one the turn may have been anything

// Slower, the base stands: wheels that stand are seen at rest, but for noise of stamps and of encoders.
constexpr double kStillSpeed = 0.005;  // [m/s]
constexpr double kStillTurn = 0.005;   // [rad/s]
constexpr double kSettling = 0.5;      // [s] that it takes to come to rest

constexpr double kLeastLearned = 1.0;  // [s]
constexpr double kMostLearned = 60.0;  // [s]; a bias drifts with the gyro's warmth
constexpr double kMostBias = 0.2;      // [rad/s]; more is a robot that somebody turns
constexpr double kMostChange = 0.05;   // [rad/s], the same once the bias is known

// A bias that was learned wrong, as the robot was turned by hand or the gyro warmed up: what it tells at rest instead
// for so long, and evenly as no hand turns, is the bias.
constexpr double kRelearned = 5.0;  // [s]
constexpr double kEvenness = 0.05;  // [rad/s]

// A gyro that says exactly "no turn" for so long while odometry turns is broken: a sound one has noise.
constexpr double kDead = 1.0;     // [s]
constexpr double kNoTurn = 1e-6;  // [rad/s]

}  // namespace

void GyroOdometry::add_gyro(double time, double yaw_rate) {
  if (!std::isfinite(time) || !std::isfinite(yaw_rate)) {
    throw InputError("gyro: a time or yaw rate is not a finite number; check what publishes the IMU's messages");
  }
  if (!rates_.empty() && time <= rates_.back().time) {
    if (time >= rates_.back().time - kSetBack) return;
    rates_.clear();  // or they would shut out all that comes
  }
  rates_.push_back({time, yaw_rate});
  while (rates_.front().time < time - kKept) rates_.pop_front();
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
  if (!rates_.empty() && rates_.back().time > time + kSetBack) rates_.clear();
}

std::optional<double> GyroOdometry::bias() const {
  return learned_ >= kLeastLearned ? std::make_optional(bias_) : std::nullopt;
}

void GyroOdometry::settle() {
  while (!waiting_.empty()) {
    const double time = waiting_.front().time;
    const bool is_covered = !rates_.empty() && rates_.back().time >= time;
    if (!is_covered && newest_odometry_ <= time + kPatience) return;
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
    const bool is_still =
        motion.translation().norm() <= kStillSpeed * duration && std::abs(motion.theta) <= kStillTurn * duration;
    still_ = is_still ? still_ + duration : 0.0;
    const std::optional<double> turn = integral(last_->time, now.time);
    if (turn && still_ > kSettling) learn_bias(*turn / duration, duration);
    const bool is_dead = is_silent(turn, motion.theta, duration);
    const bool is_used = turn && bias() && !is_dead && !(is_still && std::abs(*turn / duration - bias_) <= kMostChange);
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
  if (std::abs(told_by_odometry) <= kMostChange * duration) return silent_ >= kDead;
  const bool says_nothing = turn && std::abs(*turn - bias_ * duration) <= kNoTurn * duration;
  silent_ = says_nothing ? silent_ + duration : 0.0;
  return silent_ >= kDead;
}

// A mean over the time that the base stood, the latest minute of it.
void GyroOdometry::learn_bias(double mean_rate, double duration) {
  const bool is_contrary = std::abs(mean_rate - bias_) > (bias() ? kMostChange : kMostBias);
  if (is_contrary && std::abs(mean_rate - contrary_) <= kEvenness && std::abs(mean_rate) <= kMostBias) {
    contrary_for_ += duration;
    contrary_ += (mean_rate - contrary_) * std::min(1.0, duration / contrary_for_);
    if (contrary_for_ < kRelearned) return;
    bias_ = contrary_;
    learned_ = std::exchange(contrary_for_, 0.0);
    return;
  }
  contrary_ = mean_rate;
  contrary_for_ = 0.0;
  if (is_contrary) return;
  learned_ = std::min(learned_ + duration, kMostLearned);
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
    if (span > kMostGap) return std::nullopt;
    const double from = std::max(a.time, begin);
    const double to = std::min(b.time, end);
    const auto at = [&](double t) { return a.value + (b.value - a.value) * (t - a.time) / span; };
    sum += 0.5 * (at(from) + at(to)) * (to - from);
  }
  return sum;
}

}  // namespace oort
