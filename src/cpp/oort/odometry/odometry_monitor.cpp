// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/odometry/odometry_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace oort {
namespace {

// What no robot on wheels, and nobody who carries a sensor on foot, exceeds.
constexpr double kMostSpeed = 4.0;              // [m/s]
constexpr double kMostTurnRate = 6.0;           // [rad/s]
constexpr double kMostAcceleration = 5.0;       // [m/s^2]; a robot that brakes hard does 3
constexpr double kMostTurnAcceleration = 15.0;  // [rad/s^2]
// Beside that a change of motion of so much is nothing: noise of stamps and readings.
constexpr double kSlack = 0.1;       // [m]
constexpr double kSlackTheta = 0.1;  // [rad]

// Farther apart, stamps say nothing of accelerations.
constexpr double kLongest = 1.0;        // [s]
constexpr double kShortest = 1e-3;      // [s]
constexpr std::size_t kIntervals = 15;  // of which the mean is the usual one
constexpr std::size_t kLeastIntervals = 5;
constexpr double kBurst = 0.7;  // of the usual interval; shorter ones are no intervals

// Odometry that says exactly nothing while the robot was faster is frozen, or the robot stopped dead.
constexpr double kMoving = 0.15;  // [m/s]
constexpr double kTurning = 0.2;  // [rad/s]
constexpr double kStill = 1e-9;   // [m, rad]
// A match that differs by more from odometry that is doubted, says that it is wrong: of a jump, and, each scan, of a
// robot that should stand. Matches of a robot at rest differ by some millimetres.
constexpr double kWrongJump = 0.1;        // [m]
constexpr double kWrongTurn = 0.1;        // [rad]
constexpr double kWrongRest = 0.015;      // [m]
constexpr double kWrongRestTurn = 0.015;  // [rad]
// What odometry missed in all while it should have stood, from which on it is frozen.
constexpr double kMissed = 0.1;       // [m]
constexpr double kMissedTurn = 0.15;  // [rad]

constexpr std::size_t kMostKept = 1000;

double distance(const Pose2& motion) {
  return motion.translation().norm();
}

bool is_still(const Pose2& motion) {
  return distance(motion) < kStill && std::abs(motion.theta) < kStill;
}

}  // namespace

bool MotionHypotheses::holds(const Pose2& T_before_after_matched) const {
  const Pose2 off = between(T_before_after_odometry, T_before_after_matched);
  return distance(off) <= (is_standing ? kWrongRest : kWrongJump) &&
         std::abs(off.theta) <= (is_standing ? kWrongRestTurn : kWrongTurn);
}

MotionHypotheses OdometryMonitor::judge(double time, const Pose2& T_before_after) {
  const double interval = last_time_ ? paced(time - *last_time_) : 0.0;
  last_time_ = time;
  judged_ = {interval, T_before_after};
  MotionHypotheses hypotheses;
  hypotheses.T_before_after_odometry = T_before_after;
  hypotheses.is_standing = is_still(T_before_after);
  const std::optional<Pose2> on = going_on(interval);
  const bool possible = interval < kShortest || is_possible(interval, T_before_after);
  const bool was_moving = believed_ && believed_->interval >= kShortest &&
                          (distance(believed_->T_before_after) > kMoving * believed_->interval ||
                           std::abs(believed_->T_before_after.theta) > kTurning * believed_->interval);
  if (is_frozen_ && !is_still(T_before_after)) {
    hypotheses.T_before_after = {inverse(missed_) * T_before_after, T_before_after};
    if (on) {
      const auto strangeness = [&](const Pose2& motion) {
        const Pose2 change = between(*on, motion);
        return distance(change) + std::abs(change.theta);
      };
      if (strangeness(T_before_after) < strangeness(hypotheses.T_before_after[0])) {
        std::swap(hypotheses.T_before_after[0], hypotheses.T_before_after[1]);
      }
      hypotheses.T_before_after.push_back(*on);
    }
  } else if (is_still(T_before_after) && on && was_moving) {
    hypotheses.T_before_after = {T_before_after, *on};
  } else {
    hypotheses.T_before_after = {T_before_after};
    if (!possible) {
      hypotheses.T_before_after = {on.value_or(Pose2{}), T_before_after};
      if (on) hypotheses.T_before_after.push_back(Pose2{});
    }
  }
  judged_doubted_ = hypotheses.is_doubted();
  return hypotheses;
}

void OdometryMonitor::moved(const Pose2& T_before_after, bool is_matched) {
  const auto add_fault = [&](OdometryFault::Kind kind, const Pose2& off) {
    ++fault_count_;
    if (faults_.size() < kMostKept) faults_.push_back({kind, *last_time_, distance(off), std::abs(off.theta)});
  };
  if (is_still(judged_.T_before_after)) {
    if (is_matched) missed_ = missed_ * T_before_after;
    const bool frozen = distance(missed_) > kMissed || std::abs(missed_.theta) > kMissedTurn;
    if (frozen && !is_frozen_) add_fault(OdometryFault::Kind::kFreeze, missed_);
    is_frozen_ = is_frozen_ || frozen;
  } else {
    if (judged_doubted_ && is_matched && !is_frozen_) {
      add_fault(OdometryFault::Kind::kJump, between(judged_.T_before_after, T_before_after));
    }
    is_frozen_ = false;
    missed_ = Pose2{};
  }
  believed_ = Motion{judged_.interval, T_before_after};
}

void OdometryMonitor::forget() {
  last_time_.reset();
  intervals_.clear();
  believed_.reset();
  missed_ = Pose2{};
  is_frozen_ = false;
}

/// The time between two scans. Stamps are often those of arrival: scans that come in bursts were not taken in one. What
/// is much shorter than usual is taken for the usual.
double OdometryMonitor::paced(double interval) {
  if (interval > 0.0) intervals_.push_back(interval);
  if (intervals_.size() > kIntervals) intervals_.pop_front();
  if (intervals_.empty()) return interval;
  const double usual =
      std::accumulate(intervals_.begin(), intervals_.end(), 0.0) / static_cast<double>(intervals_.size());
  return interval < kBurst * usual ? usual : interval;
}

bool OdometryMonitor::is_possible(double interval, const Pose2& motion) const {
  if (distance(motion) > kMostSpeed * interval + kSlack ||
      std::abs(motion.theta) > kMostTurnRate * interval + kSlackTheta) {
    return false;
  }
  const std::optional<Pose2> on = going_on(interval);
  if (!on) return true;
  const Pose2 change = between(*on, motion);
  return distance(change) <= kMostAcceleration * interval * interval + kSlack &&
         std::abs(change.theta) <= kMostTurnAcceleration * interval * interval + kSlackTheta;
}

/// The last motion for so long; none if the stamps do not tell.
std::optional<Pose2> OdometryMonitor::going_on(double interval) const {
  if (intervals_.size() < kLeastIntervals) return std::nullopt;
  if (!believed_ || believed_->interval < kShortest || believed_->interval > kLongest) return std::nullopt;
  if (interval < kShortest || interval > kLongest) return std::nullopt;
  const double ratio = interval / believed_->interval;
  const Pose2& motion = believed_->T_before_after;
  return Pose2{ratio * motion.x, ratio * motion.y, wrap_angle(ratio * motion.theta)};
}

}  // namespace oort
