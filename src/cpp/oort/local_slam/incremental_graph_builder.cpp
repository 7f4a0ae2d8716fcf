// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/local_slam/incremental_graph_builder.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "oort/local_slam/match_gates.hpp"
#include "oort/local_slam/tuning.hpp"

namespace oort {
namespace {

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

/// Next to nothing is known, yet an edge of it is one that submaps may be drawn over (TrajectorySegments).
Eigen::Matrix3d diffuse_covariance() {
  return LocalSlamTuning::kDiffuseVariance * Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d doubted_motion() {
  return Eigen::Vector3d(LocalSlamTuning::kDoubtedSigma, LocalSlamTuning::kDoubtedSigma,
                         LocalSlamTuning::kDoubtedSigmaTheta)
      .cwiseAbs2()
      .asDiagonal();
}

OdometryModel odometry_model(const OdometryNoiseParameters& p, bool use_odometry) {
  if (!use_odometry) return LocalSlamTuning::kNoOdometry;
  return {p.translation_per_meter, p.translation_per_radian, p.rotation_per_meter,
          p.rotation_per_radian,   p.translation_floor,      p.rotation_floor};
}

}  // namespace

EdgeParameters edge_parameters(const IncrementalGraphBuilderParameters& parameters) {
  const auto of = [](const auto& p, double min_inlier_ratio, bool odometry_is_prior) {
    return EdgeParameters{p.scanmatch_cov_scale,
                          p.inflate_scanmatch_cov_scale,
                          p.resume_scanmatch_cov_scale,
                          p.heading_error_per_meter,
                          min_inlier_ratio,
                          odometry_is_prior};
  };
  if (parameters.scanmatcher == "cartographer_matcher") {
    return of(parameters.cartographer_matcher, parameters.cartographer_matcher.min_sm_accept_score, false);
  }
  return of(parameters.frsm_matcher, parameters.frsm_matcher.match_filtering.min_accept_score, true);
}

IncrementalGraphBuilder::IncrementalGraphBuilder(const Parameters& parameters)
    : parameters_(parameters.incremental_graph_builder),
      motion_model_(parameters_.odometry_model == "motion"),
      odometry_model_(odometry_model(parameters_.odometry_noise, parameters.use_odometry),
                      parameters.use_odometry ? parameters_.odometry_noise.least_learned : 1.0),
      edge_parameters_(edge_parameters(parameters_)),
      tracker_(make_scan_tracker(parameters)) {}

void IncrementalGraphBuilder::begin(const Pose2& T_local_sensor) {
  tracker_->reset(T_local_sensor);
}

TrackedScan IncrementalGraphBuilder::track(const frsm::Points& points, double time, const Pose2& T_previous_sensor,
                                           const std::vector<Pose2>& alternatives, const std::optional<Pose2>& reversed,
                                           const std::optional<Eigen::Matrix3d>& covariance) {
  const Eigen::Matrix3d doubt = alternatives.empty() ? Eigen::Matrix3d::Zero() : doubted_motion();
  const auto motion = [&](const Pose2& T) { return Motion{T, covariance.value_or(prior_covariance(T)) + doubt}; };
  std::vector<Motion> others;
  others.reserve(alternatives.size());
  for (const Pose2& alternative : alternatives) others.push_back(motion(alternative));
  if (reversed) {
    others.push_back(motion(*reversed));
    others.back().only_if_poor = true;
  }
  TrackedScan tracked = tracker_->track(points, time, motion(T_previous_sensor), others);
  tracked.extent = extent_of(points);
  return tracked;
}

bool IncrementalGraphBuilder::is_placed(const TrackedScan& scan) const {
  return scan.usable() && scan.inlier_ratio >= edge_parameters_.min_inlier_ratio;
}

MatchedEdge IncrementalGraphBuilder::make_edge(const Pose2& T_local_anchor, const Pose2& T_anchor_node_odometry,
                                               const TrackedScan& node, bool odometry_has_edges,
                                               const Eigen::Matrix3d& doubt) {
  MatchedEdge edge;
  edge.T_anchor_node = between(T_local_anchor, node.T_local_sensor);
  const Eigen::Matrix3d odometry = odometry_covariance(T_anchor_node_odometry) + doubt;
  const Pose2 T_odometry_match = between(T_anchor_node_odometry, edge.T_anchor_node);
  edge.rejection = match_rejection(parameters_, node, T_local_anchor, T_anchor_node_odometry);
  const bool comparable = motion_model_ && edge_parameters_.odometry_is_prior;
  if (comparable && node.inlier_ratio >= LocalSlamTuning::kTellingInliers && is_too_far(edge.rejection)) {
    edge.contradicts_odometry = true;
    edge.T_anchor_node_weighed = T_anchor_node_odometry;
  }
  edge.covariance = match_covariance(node, T_local_anchor.theta, odometry_has_edges ? diffuse_covariance() : odometry,
                                     edge.T_anchor_node.translation().norm());
  if (motion_model_ && edge.rejection == Rejection::kNone) {
    if (comparable) compare(node, T_local_anchor.theta, T_anchor_node_odometry, doubt, edge);
    const bool telling = doubt.isZero(0.0) && !node.degenerate && node.inlier_ratio >= LocalSlamTuning::kTellingInliers;
    if (telling) odometry_model_.learn(T_anchor_node_odometry, T_odometry_match);
  }
  return edge;
}

void IncrementalGraphBuilder::correct(const Pose2& T_local_sensor) {
  tracker_->set_pose(T_local_sensor);
}

Eigen::Matrix3d IncrementalGraphBuilder::prior_covariance(const Pose2& T_before_after) const {
  if (motion_model_) return odometry_model_.covariance(T_before_after);
  // The original's prior multiplies scores by exp(-d^2 / w) when w > 0.1: a Gaussian of variance w / 2 on the position
  // and none on the heading. "None" is written as a turn of one radian, far beyond any search window.
  const double w = parameters_.frsm_matcher.std_mot_model;
  const double position = w > 0.1 ? w / 2.0 : 1.0;
  return Eigen::Vector3d(position, position, 1.0).asDiagonal();
}

Eigen::Matrix3d IncrementalGraphBuilder::odometry_covariance(const Pose2& T_before_after, Rejection rejection) const {
  if (motion_model_) {
    const bool undisputed = rejection == Rejection::kNone || nothing_was_seen(rejection);
    return undisputed ? odometry_model_.covariance(T_before_after) : odometry_model_.model().covariance(T_before_after);
  }
  return Eigen::Vector3d(parameters_.odom_cov_xx, parameters_.odom_cov_yy, parameters_.odom_cov_tt).asDiagonal();
}

Eigen::Matrix3d IncrementalGraphBuilder::match_covariance(const TrackedScan& node, double heading,
                                                          const Eigen::Matrix3d& others, double distance) const {
  const double scale = edge_parameters_.scanmatch_cov_scale;
  Eigen::Matrix3d covariance;
  if (motion_model_) {
    // What the match does not see (a corridor's axis) is known from odometry: the information of both is added.
    covariance = (match_information(node, heading) + others.inverse()).inverse();
    const double heading_error = edge_parameters_.heading_error_per_meter * distance;
    const double turn = LocalSlamTuning::kSurfaceError / std::max(node.extent, LocalSlamTuning::kMinExtent);
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
                                      const Eigen::Matrix3d& doubt, MatchedEdge& edge) const {
  const Pose2& driven = T_anchor_node_odometry;
  const Eigen::Vector3d difference(edge.T_anchor_node.x - driven.x, edge.T_anchor_node.y - driven.y,
                                   wrap_angle(edge.T_anchor_node.theta - driven.theta));
  // A slip is none of what is learned.
  const Eigen::Matrix3d odometry = odometry_model_.model().covariance(driven) + doubt;
  edge.contradicts_odometry = difference.dot(odometry.inverse() * difference) > LocalSlamTuning::kContradiction;
  const Eigen::Matrix3d match = match_information(node, heading);
  const Eigen::Matrix3d doubted =
      LocalSlamTuning::kContradictedSigma * LocalSlamTuning::kContradictedSigma * Eigen::Matrix3d::Identity() +
      odometry;
  const Eigen::Vector3d towards_match = (match + doubted.inverse()).inverse() * match * difference;
  edge.T_anchor_node_weighed = {driven.x + towards_match.x(), driven.y + towards_match.y(),
                                wrap_angle(driven.theta + towards_match.z())};
}

Eigen::Matrix3d IncrementalGraphBuilder::match_information(const TrackedScan& node, double heading) const {
  const double scale = edge_parameters_.scanmatch_cov_scale;
  return rotate_covariance(node.information, -heading) / (scale * scale);
}

}  // namespace oort
