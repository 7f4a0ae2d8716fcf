// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/local_slam/frsm_scan_tracker.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "oort/local_slam/tuning.hpp"
#include "oort/matching/frsm_adapter.hpp"
#include "oort/matching/frsm_setup.hpp"

namespace oort {
namespace {

frsm::TrackerParams tracker_params(const FrsmMatcherParameters& p, bool use_odometry) {
  frsm::TrackerParams params;
  params.table = table_params(p);
  params.contours = frsm::ContourParams::urg();
  params.contours.max_beam_step = LocalSlamTuning::kMaxBeamStep;
  params.contours.widest_beam_step = LocalSlamTuning::kWidestBeamStep;
  params.matcher = matcher_params(p);
  params.add = p.key_scan_distance > 0.0 ? frsm::AddRule{} : frsm::AddRule::by_hits(p.add_scan_hit_thresh);
  if (p.key_scan_distance > 0.0) {
    params.add.hit_threshold = p.add_scan_hit_thresh;
    params.add.key_distance = p.key_scan_distance;
    params.add.key_angle = p.key_scan_angle;
  }
  params.max_num_scans = p.max_num_scans;
  params.initial_search_range_xy = p.initial_search_range_xy;
  params.initial_search_range_theta = p.initial_search_range_theta;
  const auto widest = [&](double parameter, double without_odometry) {
    return use_odometry ? parameter : std::max(parameter, without_odometry);
  };
  params.max_search_range_xy = widest(p.max_search_range_xy, LocalSlamTuning::kBlindWindow);
  params.max_search_range_theta = widest(p.max_search_range_theta, LocalSlamTuning::kBlindWindowTheta);
  params.stationary_motion_model = p.stationary_motion_model;
  return params;
}

/// Why the tracker did not take a match: it asks for a higher inlier ratio than the matcher after scans without a
/// match.
Rejection rejection_of_unmatched(frsm::Status status) {
  return status == frsm::Status::kOk ? Rejection::kFewHitsAfterGap : rejection_of(status);
}

}  // namespace

FrsmScanTracker::FrsmScanTracker(const FrsmMatcherParameters& parameters, bool use_odometry)
    : tracker_(tracker_params(parameters, use_odometry)), error_(match_error(parameters)) {}

void FrsmScanTracker::reset(const Pose2& T_local_sensor) {
  tracker_.reset(to_frsm(T_local_sensor));
}

TrackedScan FrsmScanTracker::track(const frsm::Points& points, double time, const Motion& motion,
                                   const std::vector<Motion>& alternatives) {
  const auto of = [](const Motion& m) { return frsm::Motion{to_frsm(m.T_before_after), m.covariance, m.only_if_poor}; };
  std::vector<frsm::Motion> others;
  others.reserve(alternatives.size());
  for (const Motion& alternative : alternatives) others.push_back(of(alternative));
  const long restarts = tracker_.restarts();
  const frsm::Match match = tracker_.track(points, time, of(motion), others);
  TrackedScan tracked;
  tracked.T_local_sensor = from_frsm(match.pose);
  tracked.information = match.information;
  tracked.covariance = match.covariance + error_;
  // I (1 + E I)^-1 is (I^-1 + E)^-1, where what is not seen has no inverse.
  if (!error_.isZero(0.0)) {
    const Eigen::Matrix3d blurred = Eigen::Matrix3d::Identity() + error_ * match.information;
    tracked.information = match.information * blurred.inverse();
  }
  tracked.inlier_ratio = match.inlier_ratio;
  tracked.degenerate = match.degenerate;
  tracked.hypothesis = tracker_.hypothesis();
  tracked.restarted = tracker_.restarts() > restarts;
  tracked.rejection = tracker_.matched() ? Rejection::kNone : rejection_of_unmatched(match.status);
  return tracked;
}

void FrsmScanTracker::set_pose(const Pose2& T_local_sensor) {
  tracker_.set_pose(to_frsm(T_local_sensor));
}

}  // namespace oort
