// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapping/incremental_graph_builder.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "oort/mapping/frsm_setup.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

// Refusals of matches that are farther from odometry than match_filtering allows.
constexpr const char* kTooFarX = "x";
constexpr const char* kTooFarY = "y";
constexpr const char* kTooFarTheta = "theta";

// Surfaces in the local map are off by this much from one another [m], which turns a scan that sees little of them. Of
// 60 degree views in simulated homes, links err by 0.014 rad where the returns lie within 0.5 m of their middle.
constexpr double kSurfaceError = 0.005;
constexpr double kLeastExtent = 0.1;  // [m]

double extent_of(const frsm::Points& points) {
  double x = 0.0, y = 0.0, squares = 0.0;
  for (const frsm::Point& p : points) {
    x += p.x;
    y += p.y;
    squares += p.x * p.x + p.y * p.y;
  }
  const auto n = static_cast<double>(std::max<std::size_t>(points.size(), 1));
  return std::sqrt(std::max(squares / n - (x * x + y * y) / (n * n), 0.0));
}

// A match tells how good odometry is if so many of its returns hit.
constexpr double kTellingHits = 0.8;

frsm::TrackerParams tracker_params(const FrsmMatcherParameters& p) {
  frsm::TrackerParams params;
  params.table = table_params(p);
  params.contours = frsm::ContourParams::urg();
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
  params.max_search_range_xy = p.max_search_range_xy;
  params.max_search_range_theta = p.max_search_range_theta;
  params.stationary_motion_model = p.stationary_motion_model;
  return params;
}

// Odometry and match contradict each other beyond this squared distance: once in 10^5 times by chance (chi-square of 3
// degrees of freedom).
constexpr double kContradiction = 25.9;

// How much less certain odometry then is [m and rad]: far less than what a match sees, more than what it does not.
constexpr double kDoubt = 0.25;

/// Next to nothing is known, yet a link of it is one that submaps may be drawn over (Chains).
Eigen::Matrix3d diffuse_covariance() {
  return Eigen::Vector3d(0.2, 0.2, 0.2).asDiagonal();  // 0.45 m and 0.45 rad
}

OdometryModel odometry_model(const OdometryNoiseParameters& p) {
  return {p.translation_per_meter, p.translation_per_radian, p.rotation_per_meter,
          p.rotation_per_radian,   p.translation_floor,      p.rotation_floor};
}

}  // namespace

IncrementalGraphBuilder::IncrementalGraphBuilder(const Parameters& parameters)
    : parameters_(parameters.incremental_graph_builder),
      motion_model_(parameters_.odometry_model == "motion"),
      odometry_model_(odometry_model(parameters_.odometry_noise), parameters_.odometry_noise.least_learned),
      tracker_(tracker_params(parameters_.frsm_matcher)) {}

void IncrementalGraphBuilder::begin(const Pose2& T_local_sensor) {
  tracker_.reset(to_frsm(T_local_sensor));
}

TrackedScan IncrementalGraphBuilder::track(const frsm::Points& points, double time, const Pose2& T_previous_sensor) {
  const frsm::Motion motion{to_frsm(T_previous_sensor), prior_covariance(T_previous_sensor)};
  const long restarts = tracker_.restarts();
  const frsm::Match match = tracker_.track(points, time, motion);
  TrackedScan tracked;
  tracked.T_local_sensor = from_frsm(match.pose);
  tracked.information = match.information;
  tracked.covariance = match.covariance;
  tracked.hit_fraction = match.hit_fraction;
  tracked.extent = extent_of(points);
  tracked.degenerate = match.degenerate;
  tracked.usable = tracker_.matched();
  tracked.restarted = tracker_.restarts() > restarts;
  tracked.status = frsm::to_string(match.status);
  return tracked;
}

bool IncrementalGraphBuilder::is_placed(const TrackedScan& scan) const {
  return scan.usable && scan.hit_fraction >= parameters_.frsm_matcher.match_filtering.min_accept_score;
}

MatchLink IncrementalGraphBuilder::link(const Pose2& T_local_anchor, const Pose2& T_anchor_node_odometry,
                                        const TrackedScan& node, bool odometry_is_linked) {
  MatchLink link;
  link.T_anchor_node = between(T_local_anchor, node.T_local_sensor);
  const Eigen::Matrix3d odometry = odometry_covariance(T_anchor_node_odometry);
  const Pose2 T_odometry_match = between(T_anchor_node_odometry, link.T_anchor_node);
  link.refusal = refusal(node, T_odometry_match);
  if (motion_model_ && node.hit_fraction >= kTellingHits &&
      (link.refusal == kTooFarX || link.refusal == kTooFarY || link.refusal == kTooFarTheta)) {
    link.contradicts_odometry = true;
    link.T_anchor_node_weighed = T_anchor_node_odometry;
  }
  link.covariance = match_covariance(node, T_local_anchor.theta, odometry_is_linked ? diffuse_covariance() : odometry,
                                     link.T_anchor_node.translation().norm());
  if (motion_model_ && link.refusal.empty()) {
    compare(node, T_local_anchor.theta, T_anchor_node_odometry, link);
    const bool telling = !node.degenerate && node.hit_fraction >= kTellingHits;
    if (telling) odometry_model_.learn(T_anchor_node_odometry, T_odometry_match);
  }
  return link;
}

void IncrementalGraphBuilder::correct(const Pose2& T_local_sensor) {
  tracker_.set_pose(to_frsm(T_local_sensor));
}

std::string IncrementalGraphBuilder::refusal(const TrackedScan& node, const Pose2& T_odometry_match) const {
  const MatchFilteringParameters& filter = parameters_.frsm_matcher.match_filtering;
  if (!node.usable) return node.status;
  if (node.hit_fraction < filter.min_accept_score) return "score";
  if (T_odometry_match.x < filter.x_min_accept || T_odometry_match.x > filter.x_max_accept) return kTooFarX;
  if (std::abs(T_odometry_match.y) > filter.y_abs_accept) return kTooFarY;
  if (std::abs(T_odometry_match.theta) > filter.theta_abs_accept) return kTooFarTheta;
  return "";
}

Eigen::Matrix3d IncrementalGraphBuilder::prior_covariance(const Pose2& T_before_after) const {
  if (motion_model_) return odometry_model_.covariance(T_before_after);
  // The original's prior multiplies scores by exp(-d^2 / w) when w > 0.1: a Gaussian of variance w / 2 on the position
  // and none on the heading. "None" is written as a turn of one radian, far beyond any search window.
  const double w = parameters_.frsm_matcher.std_mot_model;
  const double position = w > 0.1 ? w / 2.0 : 1.0;
  return Eigen::Vector3d(position, position, 1.0).asDiagonal();
}

Eigen::Matrix3d IncrementalGraphBuilder::odometry_covariance(const Pose2& T_before_after,
                                                             const std::string& refusal) const {
  using frsm::Status;
  const bool undisputed = refusal.empty() || refusal == frsm::to_string(Status::kEmptyScan) ||
                          refusal == frsm::to_string(Status::kTooFewPoints) ||
                          refusal == frsm::to_string(Status::kNoOverlap);
  if (motion_model_) {
    return undisputed ? odometry_model_.covariance(T_before_after) : odometry_model_.model().covariance(T_before_after);
  }
  return Eigen::Vector3d(parameters_.odom_cov_xx, parameters_.odom_cov_yy, parameters_.odom_cov_tt).asDiagonal();
}

Eigen::Matrix3d IncrementalGraphBuilder::match_covariance(const TrackedScan& node, double heading,
                                                          const Eigen::Matrix3d& others, double distance) const {
  const double scale = parameters_.frsm_matcher.scanmatch_cov_scale;
  Eigen::Matrix3d covariance;
  if (motion_model_) {
    // What the match does not see (a corridor's axis) is known from odometry: the information of both is added.
    covariance = (match_information(node, heading) + others.inverse()).inverse();
    const double heading_error = parameters_.frsm_matcher.heading_error_per_meter * distance;
    const double turn = kSurfaceError / std::max(node.extent, kLeastExtent);
    covariance(2, 2) += heading_error * heading_error + turn * turn;
  } else {
    // As the original did: the matcher's own covariance, scaled, without its terms between position and heading.
    covariance = rotate_covariance(node.covariance, -heading) * (scale * scale);
    covariance.topRightCorner<2, 1>().setZero();
    covariance.bottomLeftCorner<1, 2>().setZero();
  }
  return 0.5 * (covariance + covariance.transpose());
}

// The match is that of a score with odometry as its prior: it differs from odometry by less than odometry errs, and not
// at all along what it does not see. If it does not, another guess than odometry's was followed (frsm::Tracker).
void IncrementalGraphBuilder::compare(const TrackedScan& node, double heading, const Pose2& T_anchor_node_odometry,
                                      MatchLink& link) const {
  const Pose2& driven = T_anchor_node_odometry;
  const Eigen::Vector3d difference(link.T_anchor_node.x - driven.x, link.T_anchor_node.y - driven.y,
                                   wrap_angle(link.T_anchor_node.theta - driven.theta));
  const Eigen::Matrix3d odometry = odometry_model_.model().covariance(driven);  // a slip is none of what is learned
  link.contradicts_odometry = difference.dot(odometry.inverse() * difference) > kContradiction;
  const Eigen::Matrix3d match = match_information(node, heading);
  const Eigen::Matrix3d doubted = kDoubt * kDoubt * Eigen::Matrix3d::Identity() + odometry;
  const Eigen::Vector3d towards_match = (match + doubted.inverse()).inverse() * match * difference;
  link.T_anchor_node_weighed = {driven.x + towards_match.x(), driven.y + towards_match.y(),
                                wrap_angle(driven.theta + towards_match.z())};
}

Eigen::Matrix3d IncrementalGraphBuilder::match_information(const TrackedScan& node, double heading) const {
  const double scale = parameters_.frsm_matcher.scanmatch_cov_scale;
  return rotate_covariance(node.information, -heading) / (scale * scale);
}

}  // namespace oort
