// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/local_slam/grid_scan_tracker.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <utility>
#include <vector>

#include "oort/local_slam/tuning.hpp"
#include "oort/matching/ceres_matcher.hpp"
#include "oort/matching/correlative_matcher.hpp"
#include "oort/matching/frsm_adapter.hpp"
#include "oort/matching/grid_score.hpp"

namespace oort {
namespace {

// The grids, from coarse to fine: those of stages that are not wanted are not kept.
constexpr std::size_t kSearchGrid = 0;
constexpr std::size_t kRefinementGrid = 1;

std::vector<ProbabilityGridParameters> grids_of(const CartographerMatcherParameters& p) {
  std::vector<ProbabilityGridParameters> grids{p};
  if (p.use_ceres_refinement) grids.push_back(p.ceres_scan_matcher);
  if (p.use_second_stage_matcher) grids.push_back(p.second_stage_matcher.ceres_scan_matcher);
  return grids;
}

/// Whether along some direction the pull to where odometry expects the sensor says more than what is seen.
bool is_degenerate(const ScanMatch& match) {
  const Eigen::Matrix3d pull = match.covariance.inverse() - match.information;
  const Eigen::Vector2d with_heading = match.information.topRightCorner<2, 1>();
  const double heading = match.information(2, 2);
  if (!(heading > 0.0)) return true;
  const Eigen::Matrix2d seen =
      match.information.topLeftCorner<2, 2>() - with_heading * with_heading.transpose() / heading;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(seen).eigenvalues().minCoeff() < pull(0, 0);
}

void take(const ScanMatch& match, TrackedScan& tracked) {
  tracked.T_local_sensor = match.pose;
  tracked.information = match.information;
  tracked.covariance = match.covariance;
  tracked.degenerate = is_degenerate(match);
}

}  // namespace

GridScanTracker::GridScanTracker(const CartographerMatcherParameters& parameters)
    : parameters_(parameters), grids_(grids_of(parameters), parameters.history_length) {}

void GridScanTracker::reset(const Pose2& T_local_sensor) {
  grids_.clear();
  pending_.reset();
  rejected_ = 0;
  pose_ = T_local_sensor;
}

TrackedScan GridScanTracker::track(const frsm::Points& points, double /*time*/, const Motion& motion,
                                   const std::vector<Motion>& alternatives) {
  join_pending();
  const Points near = in_range(points);
  Pose2 expected = pose_ * motion.T_before_after;
  if (grids_.empty()) return begin(near, expected);
  TrackedScan tracked = match(near, expected);
  for (std::size_t k = 0; k < alternatives.size(); ++k) {
    const bool is_poor = !tracked.usable() || tracked.inlier_ratio < LocalSlamTuning::kTellingInliers;
    if (alternatives[k].only_if_poor && !is_poor) continue;
    TrackedScan other = match(near, pose_ * alternatives[k].T_before_after);
    if (other.inlier_ratio <= tracked.inlier_ratio + LocalSlamTuning::kAlternativeGain) continue;
    expected = pose_ * alternatives[k].T_before_after;
    tracked = other;
    tracked.hypothesis = k + 1;
  }
  if (tracked.usable()) {
    rejected_ = 0;
    pose_ = tracked.T_local_sensor;
    if (is_key_scan(pose_)) pending_ = Pending{near, pose_};
  } else if (++rejected_ >= LocalSlamTuning::kMaxRejectedScans) {
    reset(expected);
    tracked = begin(near, expected);
    tracked.restarted = true;
  } else {
    pose_ = tracked.T_local_sensor = expected;
  }
  return tracked;
}

void GridScanTracker::set_pose(const Pose2& T_local_sensor) {
  pose_ = T_local_sensor;
  if (grids_.empty() && pending_) {
    pending_->T_local_sensor = T_local_sensor;  // a local map's first scan joins wherever it is
  } else {
    pending_.reset();
  }
}

Points GridScanTracker::in_range(const frsm::Points& points) const {
  Points near;
  for (const Eigen::Vector2d& point : to_points(points)) {
    if (point.norm() <= parameters_.max_point_range) near.push_back(point);
  }
  return near;
}

void GridScanTracker::join_pending() {
  if (!pending_) return;
  grids_.insert(pending_->points, pending_->T_local_sensor);
  last_joined_ = pending_->T_local_sensor;
  pending_.reset();
}

bool GridScanTracker::is_key_scan(const Pose2& T_local_sensor) const {
  const Pose2 moved = between(last_joined_, T_local_sensor);
  return moved.translation().norm() >= parameters_.key_scan_distance ||
         std::abs(moved.theta) >= parameters_.key_scan_angle;
}

TrackedScan GridScanTracker::match(const Points& points, const Pose2& expected) const {
  const CartographerMatcherParameters& p = parameters_;
  const CorrelativeOptions options{p.linear_search_window, p.angular_search_window, p.translation_delta_cost_weight,
                                   p.rotation_delta_cost_weight};
  ScanMatch best = CorrelativeMatcher(grids_.grid(kSearchGrid), options).match(points, expected);
  TrackedScan tracked;
  tracked.rejection = best.rejection;
  if (!best.usable()) return tracked;
  if (p.use_ceres_refinement) {
    best = CeresMatcher(grids_.grid(kRefinementGrid), p.ceres_scan_matcher)
               .match(points, best.pose, expected.translation());
  }
  // The inlier ratio is always judged on the coarse grid: in a finer one a sparse scan leaves gaps.
  score_pose(grids_.grid(kSearchGrid), points, best);
  take(best, tracked);
  tracked.inlier_ratio = best.inlier_ratio;
  if (p.use_second_stage_matcher) {
    tracked.first_stage = CoarseMatch{best.pose, best.inlier_ratio};
    ScanMatch second = CeresMatcher(grids_.grid(p.use_ceres_refinement ? kRefinementGrid + 1 : kRefinementGrid),
                                    p.second_stage_matcher.ceres_scan_matcher)
                           .match(points, best.pose);
    score_pose(grids_.grid(kSearchGrid), points, second);
    take(second, tracked);
    tracked.inlier_ratio = second.inlier_ratio;
  }
  if (tracked.inlier_ratio < p.min_sm_accept_score) tracked.rejection = Rejection::kLowScore;
  return tracked;
}

TrackedScan GridScanTracker::begin(const Points& points, const Pose2& T_local_sensor) {
  pose_ = T_local_sensor;
  pending_ = Pending{points, T_local_sensor};
  TrackedScan tracked;
  tracked.T_local_sensor = T_local_sensor;
  tracked.rejection = Rejection::kNoHits;  // there is no local map yet
  return tracked;
}

}  // namespace oort
