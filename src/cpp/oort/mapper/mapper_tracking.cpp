// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// What a Mapper does when odometry and scans do not agree, and what it tells of how well it knows where it is.
#include <algorithm>
#include <cmath>

#include "oort/mapper/mapper.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

// A node is made when scans tell of so many times the motion that makes one due, of which odometry tells less.
constexpr double kUnnoticed = 1.5;

// When odometry and a match contradict each other: with so many hits the match is the better guess. The least variances
// of the link that stands for both; links as wide as that begin a chain wherever they are read (Chains).
constexpr double kTellingHits = 0.8;
constexpr double kContradictedVariance = 0.26;       // [m^2], for each of x and y
constexpr double kContradictedVarianceTheta = 0.06;  // [rad^2]

// A scan of which fewer hit is poorly matched; so many in a row, and the local map is not of this place.
constexpr double kPoorHits = 0.6;
constexpr int kMaxPoor = 8;

}  // namespace

// Wheels that slip, or a robot that is carried: its scans tell of a motion that odometry does not.
bool Mapper::has_moved_unnoticed(const LastScan& scan) const {
  if (next_link_ != NextLink::kChain || !scan.tracked.usable() || !incremental_.knows_odometry()) return false;
  const Pose2 T_sensor_base = inverse(T_base_sensor_);
  const Pose2 moved = between(chains_.local_pose(map_.graph.nodes.back().id) * T_sensor_base,
                              scan.tracked.T_local_sensor * T_sensor_base);
  return moved.translation().norm() >= kUnnoticed * parameters_.linear_update ||
         std::abs(moved.theta) >= kUnnoticed * parameters_.angular_update;
}

Eigen::Matrix3d Mapper::least_contradiction() {
  return Eigen::Vector3d(kContradictedVariance, kContradictedVariance, kContradictedVarianceTheta).asDiagonal();
}

// Matches go on by chance after a robot was put down elsewhere. The scans of a good match hit by nine tenths and more.
void Mapper::leave_poor_local_map(LastScan& scan) {
  const bool poor = scan.tracked.usable() && scan.tracked.hit_fraction < kPoorHits && incremental_.knows_odometry();
  poor_in_a_row_ = poor ? poor_in_a_row_ + 1 : 0;
  if (poor_in_a_row_ < kMaxPoor) return;
  poor_in_a_row_ = 0;
  const double hits = scan.tracked.hit_fraction;
  incremental_.begin(scan.tracked.T_local_sensor);
  scan.tracked = incremental_.track(returns_of(scan.cloud), scan.cloud.time, Pose2{});
  scan.tracked.hit_fraction = hits;
  scan.tracked.restarted = true;
  scan.missed = true;
  left_poor_local_map_ = true;
}

// Odometry slipped, or was carried, or the match is a chance one: which of them is not known. A new chain begins with
// the scan, whose link is as wide as what they say is apart, so that closures decide where it belongs.
Mapper::ChainStep Mapper::begin_contradicted_chain(LastScan& scan, Node& node, const Pose2& T_previous_node,
                                                   const MatchLink& match) {
  const Node& previous = map_.graph.nodes.back();
  const Pose2& T_local_previous = chains_.local_pose(previous.id);
  const Pose2 T_local_anchor = chains_.local_pose(anchor_.node);
  const auto from_previous = [&](const Pose2& T_anchor_node) {
    return between(T_local_previous, T_local_anchor * T_anchor_node);
  };
  const Pose2 apart = between(T_previous_node, from_previous(match.T_anchor_node));
  const double hits = scan.tracked.hit_fraction;
  const Pose2 chosen = hits >= kTellingHits ? from_previous(match.T_anchor_node_weighed) : T_previous_node;
  const double distance2 = apart.translation().squaredNorm();
  const Eigen::Vector3d far_apart(distance2, distance2, apart.theta * apart.theta);
  const Eigen::Matrix3d covariance = least_contradiction() + Eigen::Matrix3d(far_apart.asDiagonal());
  link_loosely(previous.id, chosen, covariance, node, scan.cloud.time);
  node.pose = previous.pose * chosen;
  incremental_.begin(T_local_previous * chosen);
  scan.tracked = incremental_.track(returns_of(scan.cloud), scan.cloud.time, Pose2{});
  scan.tracked.hit_fraction = hits;
  scan.tracked.rejection = Rejection::kContradictsOdometry;
  map_.incremental_results.push_back({node.id, node.id, scan.tracked.T_local_sensor, covariance, Pose2{}, hits});
  ++statistics_.contradictions;
  tracking_.hang_loosely(node.id, hits < kTellingHits);
  return ChainStep::kFresh;
}

void Mapper::count_tracking(TrackingState state) {
  TrackingCounts& counts = statistics_.tracking;
  if (state != tracking_state_) ++counts.changes;
  tracking_state_ = state;
  ++(state == TrackingState::kTracking ? counts.tracking
     : state == TrackingState::kLost   ? counts.lost
                                       : counts.uncertain);
}

}  // namespace oort
