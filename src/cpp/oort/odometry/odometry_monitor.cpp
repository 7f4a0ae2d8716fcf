// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/odometry/odometry_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "oort/odometry/tuning.hpp"

namespace oort {
namespace {

double distance(const Pose2& motion) {
  return motion.translation().norm();
}

bool is_still(const Pose2& motion) {
  return distance(motion) < OdometryTuning::kNoMotion && std::abs(motion.theta) < OdometryTuning::kNoMotion;
}

}  // namespace

bool MotionHypotheses::holds(const Pose2& T_before_after_matched) const {
  const Pose2 off = between(T_before_after_odometry, T_before_after_matched);
  return distance(off) <= (is_standing ? OdometryTuning::kStandingError : OdometryTuning::kJumpError) &&
         std::abs(off.theta) <= (is_standing ? OdometryTuning::kStandingErrorTheta : OdometryTuning::kJumpErrorTheta);
}

MotionHypotheses OdometryMonitor::judge(double time, const Pose2& T_before_after) {
  const double interval = last_time_ ? pace_.next(time - *last_time_) : 0.0;
  last_time_ = time;
  judged_ = {interval, T_before_after};
  MotionHypotheses hypotheses;
  hypotheses.T_before_after_odometry = T_before_after;
  hypotheses.is_standing = is_still(T_before_after);
  const std::optional<Pose2> on = going_on(interval);
  const bool possible = interval < OdometryTuning::kMinInterval || is_possible(interval, T_before_after);
  const bool was_moving = believed_ && believed_->interval >= OdometryTuning::kMinInterval &&
                          (distance(believed_->T_before_after) > OdometryTuning::kMoving * believed_->interval ||
                           std::abs(believed_->T_before_after.theta) > OdometryTuning::kTurning * believed_->interval);
  if (!is_still(missed_) && !is_still(T_before_after)) {
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
    if (!possible && catches_up(interval, T_before_after)) {
      hypotheses.T_before_after.push_back(Pose2{});
    } else if (!possible) {
      hypotheses.T_before_after = {on.value_or(Pose2{}), T_before_after};
      if (on) hypotheses.T_before_after.push_back(Pose2{});
    }
  }
  if (T_before_after.x < -OdometryTuning::kBackwards) knows_backwards_ = true;
  if (!knows_backwards_ && !hypotheses.is_doubted() && T_before_after.x > OdometryTuning::kReversible) {
    hypotheses.T_before_after_reversed = Pose2{-T_before_after.x, -T_before_after.y, T_before_after.theta};
  }
  stood_ = is_still(T_before_after) ? stood_ + interval : 0.0;
  judged_doubted_ = hypotheses.is_doubted();
  return hypotheses;
}

void OdometryMonitor::moved(const Pose2& T_before_after, bool is_matched) {
  const auto add_fault = [&](OdometryFault::Kind kind, const Pose2& off) {
    ++fault_count_;
    if (faults_.size() < OdometryTuning::kMaxFaults) {
      faults_.push_back({kind, *last_time_, distance(off), std::abs(off.theta)});
    }
  };
  if (is_still(judged_.T_before_after)) {
    missed_ = missed_ * between(judged_.T_before_after, T_before_after);  // odometry may bring it yet, matched or not
    const bool frozen = is_matched && (distance(missed_) > OdometryTuning::kFrozenError ||
                                       std::abs(missed_.theta) > OdometryTuning::kFrozenErrorTheta);
    if (frozen && !is_frozen_) add_fault(OdometryFault::Kind::kFreeze, missed_);
    is_frozen_ = is_frozen_ || frozen;
  } else {
    if (is_matched && is_still(missed_)) {  // else it catches up
      add_fault(judged_doubted_ ? OdometryFault::Kind::kJump : OdometryFault::Kind::kReversed,
                between(judged_.T_before_after, T_before_after));
    }
    is_frozen_ = false;
    missed_ = Pose2{};
  }
  believed_ = Motion{judged_.interval, T_before_after};
}

void OdometryMonitor::forget() {
  last_time_.reset();
  pace_.forget();
  believed_.reset();
  missed_ = Pose2{};
  is_frozen_ = false;
  stood_ = 0.0;
}

/// Whether that may be what the base did since odometry stood still: a freeze shows in no scan along a bare wall.
bool OdometryMonitor::catches_up(double interval, const Pose2& motion) const {
  if (stood_ <= 0.0 || stood_ > OdometryTuning::kMaxFreeze) return false;
  return distance(motion) <= OdometryTuning::kFrozenSpeed * (stood_ + interval) &&
         std::abs(motion.theta) <= OdometryTuning::kFrozenTurnRate * (stood_ + interval);
}

bool OdometryMonitor::is_possible(double interval, const Pose2& motion) const {
  if (distance(motion) > OdometryTuning::kMaxSpeed * interval + OdometryTuning::kMotionSlack ||
      std::abs(motion.theta) > OdometryTuning::kMaxTurnRate * interval + OdometryTuning::kMotionSlackTheta) {
    return false;
  }
  const std::optional<Pose2> on = going_on(interval);
  if (!on) return true;
  const Pose2 change = between(*on, motion);
  return distance(change) <= OdometryTuning::kMaxAcceleration * interval * interval + OdometryTuning::kMotionSlack &&
         std::abs(change.theta) <=
             OdometryTuning::kMaxTurnAcceleration * interval * interval + OdometryTuning::kMotionSlackTheta;
}

/// The last motion for so long; none if the stamps do not tell.
std::optional<Pose2> OdometryMonitor::going_on(double interval) const {
  if (!pace_.is_known()) return std::nullopt;
  if (!believed_ || believed_->interval < OdometryTuning::kMinInterval ||
      believed_->interval > OdometryTuning::kMaxInterval) {
    return std::nullopt;
  }
  if (interval < OdometryTuning::kMinInterval || interval > OdometryTuning::kMaxInterval) return std::nullopt;
  const double ratio = interval / believed_->interval;
  const Pose2& motion = believed_->T_before_after;
  return Pose2{ratio * motion.x, ratio * motion.y, wrap_angle(ratio * motion.theta)};
}

}  // namespace oort
