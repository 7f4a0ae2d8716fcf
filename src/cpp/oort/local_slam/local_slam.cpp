// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/local_slam/local_slam.hpp"

#include <cmath>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/local_slam/tuning.hpp"
#include "oort/map/map_check.hpp"

namespace oort {
namespace {

void check_odometry(const LaserScan& scan, const Pose2& T_odom_base) {
  if (!is_finite(T_odom_base) || !std::isfinite(scan.time)) {
    throw InputError("scan: its time or odometry pose is not finite; check the transform odom -> base");
  }
  check_reach(T_odom_base, "scan: its odometry pose");
}

}  // namespace

std::string_view to_string(ScanOutcome outcome) {
  switch (outcome) {
    case ScanOutcome::kNode:
      return "node";
    case ScanOutcome::kLocated:
      return "located";
    case ScanOutcome::kSkipped:
      return "skipped";
  }
  return "unknown";
}

LocalSlam::LocalSlam(const Parameters& parameters)
    : parameters_(parameters), lasers_(parameters, {}), trajectory_(parameters) {}

void LocalSlam::mount_sensor(const Pose2& T_base_sensor) {
  check_reach(T_base_sensor, "the sensor's pose on the base", "check the transform");
  if (last_) throw StateError("the sensor's place on the base cannot change while scans are being mapped");
  lasers_ = LaserRig(parameters_, T_base_sensor);
}

void LocalSlam::begin_map() {
  forget_motion();
  trajectory_.begin_map();
  lasers_.forget();
  last_.reset();
}

void LocalSlam::begin_session(const SessionStart& start, std::uint64_t node_count) {
  forget_motion();
  trajectory_.begin_session(start, node_count);
  lasers_.forget();
  last_.reset();
}

void LocalSlam::interrupt() {
  forget_motion();
  trajectory_.interrupt();
}

void LocalSlam::forget_motion() {
  monitor_.forget();
  velocity_.forget();
}

LocalSlam::Result LocalSlam::add_scan(const LaserScan& scan, const Pose2& T_odom_base, const Sweep& sweep_of_base) {
  check_odometry(scan, T_odom_base);
  LocalScan now;
  // Odometry's own scales are off by little over the length of a scan: the motion is taken as measured.
  now.cloud = lasers_.take(scan, T_odom_base, sweep_of_base);
  now.view_grew = lasers_.view_grew();
  now.T_odom_base_measured = T_odom_base;
  const MotionHypotheses hypotheses = expect(now);
  ++counts_.scans;

  const bool can_match = has_returns(now);
  if (!can_match) ++counts_.scans_too_small;
  bool due = can_match && is_due(now);
  const bool needs_match = parameters_.incremental_graph_builder.match_every_scan || !parameters_.use_odometry;
  if (can_match && (due || needs_match)) {
    trajectory_.track(now, hypotheses, T_base_sensor());
  } else {
    trajectory_.extrapolate(now);
  }
  now.missed = now.missed || !can_match;
  if (!parameters_.use_odometry) due = can_match && is_due(now);  // how far the base moved is known only now
  due = due || has_moved_unnoticed(now);

  if (last_) {
    const Pose2 moved = between(last_->T_odom_base, now.T_odom_base);
    if (parameters_.use_odometry) {
      monitor_.moved(moved, now.odometry_is_wrong);
    } else {
      velocity_.moved(moved, !now.missed);
      now.T_odom_base_measured = now.T_odom_base;
    }
  }

  Result result;
  result.outcome = due ? ScanOutcome::kNode : can_match ? ScanOutcome::kLocated : ScanOutcome::kSkipped;
  if (due) result.node = trajectory_.add_node(now);
  last_ = std::move(now);
  return result;
}

void LocalSlam::remember(const Pose2& T_base_sensor, const LaserScan& scan, const Pose2& T_odom_base,
                         const Sweep& sweep_of_base) {
  check_odometry(scan, T_odom_base);
  if (!is_finite(T_base_sensor)) throw InputError("the sensor's pose on the base is not finite; check the transform");
  lasers_.remember(T_base_sensor, scan, T_odom_base, sweep_of_base);
}

std::optional<TrajectoryNode> LocalSlam::make_node() {
  if (last_->is_node || !has_returns(*last_)) return std::nullopt;
  if (!last_->was_tracked) trajectory_.track(*last_, {}, T_base_sensor());
  return trajectory_.add_node(*last_);
}

/// Where odometry, with what it is always wrong by taken out of each motion, has the base; or where it likelier is, if
/// no robot moves as odometry says. Returns what the base may have done since the last scan.
MotionHypotheses LocalSlam::expect(LocalScan& scan) {
  if (!parameters_.use_odometry) {
    predict(scan);
    return {};
  }
  const IncrementalGraphBuilder& matcher = trajectory_.matcher();
  scan.T_odom_base = scan.T_odom_base_measured;
  MotionHypotheses hypotheses;
  if (last_ && matcher.knows_odometry()) {
    Pose2 moved = between(last_->T_odom_base_measured, scan.T_odom_base_measured);
    if (matcher.learns_odometry()) moved = matcher.corrected(moved);
    hypotheses = monitor_.judge(scan.cloud.time, moved);
    if (last_->missed) hypotheses.T_before_after_reversed.reset();  // a poor match may come of the way before it
    scan.T_odom_base = last_->T_odom_base * hypotheses.T_before_after.front();
  }
  scan.T_odom_sensor = scan.T_odom_base * T_base_sensor();
  return hypotheses;
}

/// The same where no odometry tells: the odometry frame begins with the first scan's base, and the base goes on as it
/// moved. The match, if there is one, will say more.
void LocalSlam::predict(LocalScan& scan) {
  const ConstantVelocity::Prediction prediction = velocity_.predict(scan.cloud.time);
  if (last_) {
    scan.T_odom_base = last_->T_odom_base * prediction.T_before_after;
    scan.motion_covariance = prediction.covariance;
  }
  scan.T_odom_base_measured = scan.T_odom_base;
  scan.T_odom_sensor = scan.T_odom_base * T_base_sensor();
}

bool LocalSlam::has_returns(const LocalScan& scan) const {
  return count_returns(scan.cloud) >= static_cast<std::size_t>(parameters_.min_pointcloud_size);
}

/// The motion gate: whether the base has moved so far that a node is due.
bool LocalSlam::is_due(const LocalScan& scan) const {
  if (!trajectory_.is_going_on()) return true;
  const double since = std::abs(scan.cloud.time - trajectory_.newest_time());  // a clock may have been set back
  if (parameters_.time_update > 0.0 && since >= parameters_.time_update) return true;
  const Pose2 moved = between(trajectory_.T_odom_base_newest(), scan.T_odom_base);
  return moved.translation().norm() >= parameters_.linear_update || std::abs(moved.theta) >= parameters_.angular_update;
}

/// Wheels that slip, or a kidnapped robot: its scans tell of a motion that odometry does not.
bool LocalSlam::has_moved_unnoticed(const LocalScan& scan) const {
  if (!trajectory_.is_going_on() || !scan.tracked.usable() || !trajectory_.matcher().knows_odometry()) return false;
  const Pose2 moved = T_base_sensor() * trajectory_.from_newest(scan.tracked.T_local_sensor) * inverse(T_base_sensor());
  return moved.translation().norm() >= LocalSlamTuning::kUnnoticedMotion * parameters_.linear_update ||
         std::abs(moved.theta) >= LocalSlamTuning::kUnnoticedMotion * parameters_.angular_update;
}

}  // namespace oort
