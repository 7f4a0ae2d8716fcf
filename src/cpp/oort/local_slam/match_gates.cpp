// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/local_slam/match_gates.hpp"

#include <cmath>

namespace oort {
namespace {

Rejection gate(const MatchFilteringParameters& filter, double inlier_ratio, const Pose2& T_odometry_match) {
  if (inlier_ratio < filter.min_accept_score) return Rejection::kScore;
  if (T_odometry_match.x < filter.x_min_accept || T_odometry_match.x > filter.x_max_accept) return Rejection::kX;
  if (std::abs(T_odometry_match.y) > filter.y_abs_accept) return Rejection::kY;
  if (std::abs(T_odometry_match.theta) > filter.theta_abs_accept) return Rejection::kTheta;
  return Rejection::kNone;
}

Rejection gate(const CartographerMatcherParameters& p, double inlier_ratio, const Pose2& T_odometry_match) {
  if (inlier_ratio < p.min_sm_accept_score) return Rejection::kScore;
  const double x =
      -T_odometry_match.x;  // these gates are on odometry minus match, those of FRSM on match minus odometry
  if (x < p.sm_dist_accept_x_min || x > p.sm_dist_accept_x_max) return Rejection::kX;
  if (std::abs(T_odometry_match.y) > p.sm_dist_accept_threshold_y) return Rejection::kY;
  if (T_odometry_match.translation().norm() > p.sm_dist_accept_threshold) return Rejection::kDistance;
  if (std::abs(T_odometry_match.theta) > p.sm_angle_accept_threshold) return Rejection::kTheta;
  return Rejection::kNone;
}

Rejection gate(const SecondStageMatcherParameters& p, double inlier_ratio, const Pose2& T_odometry_match) {
  if (inlier_ratio < p.min_sm_accept_score) return Rejection::kSecondStageScore;
  if (T_odometry_match.translation().norm() > p.sm_dist_accept_threshold) return Rejection::kSecondStageDistance;
  if (std::abs(T_odometry_match.theta) > p.sm_angle_accept_threshold) return Rejection::kSecondStageTheta;
  return Rejection::kNone;
}

}  // namespace

Rejection match_rejection(const IncrementalGraphBuilderParameters& parameters, const TrackedScan& node,
                          const Pose2& T_local_anchor, const Pose2& T_anchor_node_odometry) {
  if (!node.usable()) return node.rejection;
  const auto from_odometry = [&](const Pose2& T_local_sensor) {
    return between(T_anchor_node_odometry, between(T_local_anchor, T_local_sensor));
  };
  const Pose2 T_odometry_match = from_odometry(node.T_local_sensor);
  if (parameters.scanmatcher == "frsm_matcher") {
    return gate(parameters.frsm_matcher.match_filtering, node.inlier_ratio, T_odometry_match);
  }
  const CartographerMatcherParameters& p = parameters.cartographer_matcher;
  if (!node.first_stage) return gate(p, node.inlier_ratio, T_odometry_match);
  const Rejection first = gate(p, node.first_stage->inlier_ratio, from_odometry(node.first_stage->T_local_sensor));
  return first == Rejection::kNone ? gate(p.second_stage_matcher, node.inlier_ratio, T_odometry_match) : first;
}

bool is_too_far(Rejection rejection) {
  return rejection == Rejection::kX || rejection == Rejection::kY || rejection == Rejection::kTheta;
}

bool nothing_was_seen(Rejection rejection) {
  switch (rejection) {
    case Rejection::kEmptyScan:
    case Rejection::kTooFewPoints:
    case Rejection::kNoOverlap:
    case Rejection::kGridEmptyScan:
    case Rejection::kNoHits:
      return true;
    default:
      return false;
  }
}

}  // namespace oort
