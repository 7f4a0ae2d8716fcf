// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/local_slam/match_gates.hpp"

#include <algorithm>
#include <cmath>
#include <frsm/matcher.hpp>
#include <initializer_list>
#include <string_view>

#include "oort/matching/scan_matcher.hpp"

namespace oort {
namespace {

// Refusals of matches that are farther from odometry than the gates allow, each way.
constexpr const char* kTooFarX = "x";
constexpr const char* kTooFarY = "y";
constexpr const char* kTooFarTheta = "theta";

bool is_among(std::initializer_list<std::string_view> some, const std::string& refusal) {
  return std::find(some.begin(), some.end(), refusal) != some.end();
}

std::string refusal(const MatchFilteringParameters& filter, double hits, const Pose2& T_odometry_match) {
  if (hits < filter.min_accept_score) return "score";
  if (T_odometry_match.x < filter.x_min_accept || T_odometry_match.x > filter.x_max_accept) return kTooFarX;
  if (std::abs(T_odometry_match.y) > filter.y_abs_accept) return kTooFarY;
  if (std::abs(T_odometry_match.theta) > filter.theta_abs_accept) return kTooFarTheta;
  return "";
}

std::string refusal(const CartographerMatcherParameters& p, double hits, const Pose2& T_odometry_match) {
  if (hits < p.min_sm_accept_score) return "score";
  const double x =
      -T_odometry_match.x;  // these gates are on odometry minus match, those of FRSM on match minus odometry
  if (x < p.sm_dist_accept_x_min || x > p.sm_dist_accept_x_max) return kTooFarX;
  if (std::abs(T_odometry_match.y) > p.sm_dist_accept_threshold_y) return kTooFarY;
  if (T_odometry_match.translation().norm() > p.sm_dist_accept_threshold) return "distance";
  if (std::abs(T_odometry_match.theta) > p.sm_angle_accept_threshold) return kTooFarTheta;
  return "";
}

std::string refusal(const SecondStageMatcherParameters& p, double hits, const Pose2& T_odometry_match) {
  if (hits < p.min_sm_accept_score) return "second_stage_score";
  if (T_odometry_match.translation().norm() > p.sm_dist_accept_threshold) return "second_stage_distance";
  if (std::abs(T_odometry_match.theta) > p.sm_angle_accept_threshold) return "second_stage_theta";
  return "";
}

}  // namespace

std::string match_refusal(const IncrementalGraphBuilderParameters& parameters, const TrackedScan& node,
                          const Pose2& T_local_anchor, const Pose2& T_anchor_node_odometry) {
  if (!node.usable) return node.status;
  const auto from_odometry = [&](const Pose2& T_local_sensor) {
    return between(T_anchor_node_odometry, between(T_local_anchor, T_local_sensor));
  };
  const Pose2 T_odometry_match = from_odometry(node.T_local_sensor);
  if (parameters.scanmatcher == "frsm_matcher") {
    return refusal(parameters.frsm_matcher.match_filtering, node.hit_fraction, T_odometry_match);
  }
  const CartographerMatcherParameters& p = parameters.cartographer_matcher;
  if (!node.first_stage) return refusal(p, node.hit_fraction, T_odometry_match);
  const std::string first = refusal(p, node.first_stage->hit_fraction, from_odometry(node.first_stage->T_local_sensor));
  return first.empty() ? refusal(p.second_stage_matcher, node.hit_fraction, T_odometry_match) : first;
}

bool is_too_far(const std::string& refusal) {
  return is_among({kTooFarX, kTooFarY, kTooFarTheta}, refusal);
}

bool nothing_was_seen(const std::string& refusal) {
  using frsm::Status;
  return is_among({frsm::to_string(Status::kEmptyScan), frsm::to_string(Status::kTooFewPoints),
                   frsm::to_string(Status::kNoOverlap), to_string(MatchStatus::kEmptyScan), kNoLocalMap},
                  refusal);
}

}  // namespace oort
