// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/local_slam/trajectory_builder.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "oort/local_slam/tuning.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

Eigen::Matrix3d unmatched_covariance(double scale) {
  return LocalSlamTuning::kUnmatchedVariance * scale * scale * Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d least_contradiction() {
  return Eigen::Vector3d(LocalSlamTuning::kContradictedVariance, LocalSlamTuning::kContradictedVariance,
                         LocalSlamTuning::kContradictedVarianceTheta)
      .asDiagonal();
}

}  // namespace

TrajectoryBuilder::TrajectoryBuilder(const Parameters& parameters) : parameters_(parameters), matcher_(parameters) {}

void TrajectoryBuilder::begin_map() {
  forget();
  begin_ = Begin::kMap;
  next_id_ = 0;
}

void TrajectoryBuilder::begin_session(const SessionStart& start, std::uint64_t node_count) {
  forget();
  begin_ = Begin::kSession;
  session_ = start;
  next_id_ = node_count;
}

// A session on the map in memory is the same as one on that map loaded: nothing learned, nothing half done.
void TrajectoryBuilder::forget() {
  matcher_ = IncrementalGraphBuilder(parameters_);
  rejections_in_a_row_ = poor_in_a_row_ = 0;
}

void TrajectoryBuilder::interrupt() {
  if (begin_ == Begin::kNot) begin_ = Begin::kAfterPause;
}

void TrajectoryBuilder::renumber(const Renumbering& nodes) {
  newest_.id = nodes.of(newest_.id);
  anchor_.id = nodes.of(anchor_.id);
  next_id_ = nodes.of(next_id_);
}

void TrajectoryBuilder::track(LocalScan& scan, const MotionHypotheses& hypotheses, const Pose2& T_base_sensor) {
  Pose2 T_previous_sensor = between(T_odom_sensor_tracked_, scan.T_odom_sensor);
  const bool is_first = !is_going_on();
  if (is_first) {  // the first scan of a segment has nothing to be matched with
    Pose2 T_local_start;
    if (begin_ == Begin::kAfterPause) T_local_start = T_local_sensor_tracked_ * T_previous_sensor;
    if (begin_ == Begin::kSession) T_local_start = session_.T_map_sensor;
    matcher_.begin(T_local_start);
    local_map_ = LocalMap::kKnown;
    T_previous_sensor = Pose2{};
  }
  const bool is_doubted = !is_first && hypotheses.is_doubted();
  const bool is_judged = !is_first && !hypotheses.T_before_after.empty();
  const Pose2 T_odom_base_before = is_judged ? scan.T_odom_base * inverse(hypotheses.T_before_after.front()) : Pose2{};
  const auto motion_of_sensor = [&](const Pose2& T_before_after) {
    return between(T_odom_sensor_tracked_, T_odom_base_before * T_before_after * T_base_sensor);
  };
  std::vector<Pose2> alternatives;
  for (std::size_t k = 1; is_doubted && k < hypotheses.T_before_after.size(); ++k) {
    alternatives.push_back(motion_of_sensor(hypotheses.T_before_after[k]));
  }
  std::optional<Pose2> reversed;
  if (is_judged && hypotheses.T_before_after_reversed) reversed = motion_of_sensor(*hypotheses.T_before_after_reversed);
  scan.tracked = matcher_.track(returns_of(scan.cloud), scan.cloud.time, T_previous_sensor, alternatives, reversed,
                                scan.motion_covariance);
  scan.was_tracked = true;
  scan.missed = !is_first && !matcher_.is_placed(scan.tracked);
  if (is_doubted || scan.tracked.hypothesis > 0) settle_odometry(scan, hypotheses, T_odom_base_before, T_base_sensor);
  if (!parameters_.use_odometry && !is_first && !scan.missed) follow_match(scan, T_base_sensor);
  if (scan.tracked.restarted) local_map_ = LocalMap::kFresh;
  // What another laser sees is not on the local map: it begins anew here, in the same frame.
  if (scan.view_grew && !is_first && scan.tracked.usable()) begin_local_map(scan, scan.tracked.T_local_sensor);
  restart_if_poor(scan);
  T_odom_sensor_tracked_ = scan.T_odom_sensor;
  T_local_sensor_tracked_ = scan.tracked.T_local_sensor;
  if (scan.tracked.usable()) ++counts_.scans_matched;
}

/// A match that sees all directions says how the base moved, and whether odometry is wrong; else the hypothesis that it
/// was found with does.
void TrajectoryBuilder::settle_odometry(LocalScan& scan, const MotionHypotheses& hypotheses,
                                        const Pose2& T_odom_base_before, const Pose2& T_base_sensor) {
  const std::size_t k = scan.tracked.hypothesis;
  Pose2 moved =
      k < hypotheses.T_before_after.size() ? hypotheses.T_before_after[k] : *hypotheses.T_before_after_reversed;
  const bool is_telling =
      !scan.missed && !scan.tracked.degenerate && scan.tracked.inlier_ratio >= LocalSlamTuning::kTellingInliers;
  if (is_telling) {
    const Pose2 T_odom_sensor = T_odom_sensor_tracked_ * between(T_local_sensor_tracked_, scan.tracked.T_local_sensor);
    const Pose2 matched = between(T_odom_base_before, T_odom_sensor * inverse(T_base_sensor));
    scan.odometry_is_wrong = !hypotheses.holds(matched);
    moved = scan.odometry_is_wrong ? matched : hypotheses.T_before_after_odometry;
  }
  scan.T_odom_base = T_odom_base_before * moved;
  scan.T_odom_sensor = scan.T_odom_base * T_base_sensor;
  if (scan.odometry_is_wrong) {
    doubt(LocalSlamTuning::kDoubtedEdgeSigma, LocalSlamTuning::kDoubtedEdgeSigmaTheta);
  } else if (!is_telling) {  // which of them is true stays open
    for (const Pose2& other : hypotheses.T_before_after) {
      const Pose2 apart = between(moved, other);
      doubt(std::min(apart.translation().norm(), LocalSlamTuning::kOpenEdgeSigma),
            std::min(std::abs(apart.theta), LocalSlamTuning::kOpenEdgeSigmaTheta));
    }
  }
}

/// Odometry since the newest node is at least as uncertain as that [m, rad].
void TrajectoryBuilder::doubt(double sigma, double sigma_theta) {
  const Eigen::Vector3d variance = Eigen::Vector3d(sigma, sigma, sigma_theta).cwiseAbs2();
  doubt_since_newest_.diagonal() = doubt_since_newest_.diagonal().cwiseMax(variance);
  doubt_since_anchor_.diagonal() = doubt_since_anchor_.diagonal().cwiseMax(variance);
}

/// The odometry that there is: from match to match.
void TrajectoryBuilder::follow_match(LocalScan& scan, const Pose2& T_base_sensor) const {
  scan.T_odom_sensor = T_odom_sensor_tracked_ * between(T_local_sensor_tracked_, scan.tracked.T_local_sensor);
  scan.T_odom_base = scan.T_odom_sensor * inverse(T_base_sensor);
}

void TrajectoryBuilder::extrapolate(LocalScan& scan) const {
  scan.tracked.T_local_sensor = T_local_sensor_tracked_ * between(T_odom_sensor_tracked_, scan.T_odom_sensor);
}

TrajectoryNode TrajectoryBuilder::add_node(LocalScan& scan) {
  scan.cloud.id = next_id_;
  TrajectoryNode node = is_going_on() ? extend(scan) : begin_segment(scan);
  node.addition.cloud = std::make_shared<const PointCloud>(scan.cloud);
  node.addition.result.id = next_id_;
  node.addition.result.T_local_id = scan.tracked.T_local_sensor;
  newest_ = {next_id_++, scan.cloud.time, scan.tracked.T_local_sensor, scan.T_odom_sensor, scan.T_odom_base};
  doubt_since_newest_.setZero();
  if (node.addition.matched) {
    anchor_ = newest_;
    doubt_since_anchor_.setZero();
  }
  restart_if_rejected(scan, node.addition.matched);
  T_local_sensor_tracked_ = scan.tracked.T_local_sensor;  // linking may have corrected it
  begin_ = Begin::kNot;
  scan.is_node = true;
  ++counts_.nodes;
  return node;
}

/// The scan begins a local map at this pose. Its inlier ratio before still says how well it was matched.
void TrajectoryBuilder::begin_local_map(LocalScan& scan, const Pose2& T_local_sensor) {
  const double inlier_ratio = scan.tracked.inlier_ratio;
  matcher_.begin(T_local_sensor);
  scan.tracked = matcher_.track(returns_of(scan.cloud), scan.cloud.time, Pose2{});
  scan.tracked.inlier_ratio = inlier_ratio;
}

void TrajectoryBuilder::restart_if_poor(LocalScan& scan) {
  const bool poor =
      scan.tracked.usable() && scan.tracked.inlier_ratio < LocalSlamTuning::kPoorInliers && matcher_.knows_odometry();
  poor_in_a_row_ = poor ? poor_in_a_row_ + 1 : 0;
  if (poor_in_a_row_ < LocalSlamTuning::kMaxPoorScans) return;
  poor_in_a_row_ = 0;
  begin_local_map(scan, scan.tracked.T_local_sensor);
  scan.tracked.restarted = true;
  scan.missed = true;
  local_map_ = LocalMap::kFreshPoor;
}

void TrajectoryBuilder::restart_if_rejected(const LocalScan& scan, bool matched) {
  rejections_in_a_row_ = matched ? 0 : rejections_in_a_row_ + 1;
  if (rejections_in_a_row_ < LocalSlamTuning::kMaxRejectedNodes) return;
  matcher_.begin(scan.tracked.T_local_sensor);
  local_map_ = LocalMap::kFresh;
}

TrajectoryNode TrajectoryBuilder::begin_segment(LocalScan& scan) {
  const EdgeParameters p = edge_parameters(parameters_.incremental_graph_builder);
  TrajectoryNode node;
  node.addition.begins_segment = true;
  node.addition.result.target = next_id_;
  node.addition.result.covariance = unmatched_covariance(p.scanmatch_cov_scale);
  if (begin_ == Begin::kMap) return node;
  const bool is_session = begin_ == Begin::kSession;
  const std::uint64_t target = is_session ? session_.nearest_node : newest_.id;
  node.attachment = Attachment::kUntied;
  node.addition.from = target;
  node.addition.T_from_node =
      is_session ? session_.T_nearest_sensor : between(newest_.T_odom_sensor, scan.T_odom_sensor);
  node.addition.edges = {
      wide_edge(target, node.addition.T_from_node,
                unmatched_covariance(is_session ? p.resume_scanmatch_cov_scale : p.inflate_scanmatch_cov_scale), scan)};
  return node;
}

TrajectoryNode TrajectoryBuilder::extend(LocalScan& scan) {
  const Pose2 T_newest_node = between(newest_.T_odom_sensor, scan.T_odom_sensor);
  // What is matched after a gap says where the node is from before the gap, not from the nodes within.
  const bool after_gap = anchor_.id != newest_.id;
  MatchedEdge match = matcher_.make_edge(anchor_.T_local_sensor, between(anchor_.T_odom_sensor, scan.T_odom_sensor),
                                         scan.tracked, after_gap && matcher_.knows_odometry(), doubt_since_anchor_);
  const bool is_fresh = local_map_ != LocalMap::kKnown;
  if (match.contradicts_odometry && !is_fresh) return contradict(scan, T_newest_node, match);
  if (is_fresh) match.rejection = Rejection::kRestarted;  // the anchor is not on the map that the scan was matched with
  const bool believed = match.rejection == Rejection::kNone;
  TrajectoryNode node;
  const auto add_edge = [&](std::uint64_t from, const Pose2& pose, const Eigen::Matrix3d& covariance,
                            ConstraintType type) {
    node.addition.edges.push_back({0, from, next_id_, {scan.cloud.time, next_id_, pose, covariance, type}});
  };
  if (!believed || after_gap) {
    Eigen::Matrix3d covariance = matcher_.odometry_covariance(T_newest_node, match.rejection) + doubt_since_newest_;
    const bool is_unknown = local_map_ == LocalMap::kFreshPoor || (is_fresh && !parameters_.use_odometry);
    if (is_unknown) covariance += least_contradiction();
    add_edge(newest_.id, T_newest_node, covariance, ConstraintType::kOdometry);
  }
  if (believed) {
    add_edge(anchor_.id, match.T_anchor_node, match.covariance, ConstraintType::kLaser);
    node.addition.from = anchor_.id;
    node.addition.T_from_node = match.T_anchor_node;
  } else {
    ++counts_.odometry_edges;
    ++counts_.match_rejections[match.rejection];
    scan.missed = true;
    node.addition.from = newest_.id;
    node.addition.T_from_node = T_newest_node;
    if (!is_fresh) {
      scan.tracked.T_local_sensor = newest_.T_local_sensor * T_newest_node;
      matcher_.correct(scan.tracked.T_local_sensor);
    }
  }
  node.addition.begins_segment = is_fresh;
  node.addition.matched = believed || is_fresh;
  if (is_fresh) node.attachment = local_map_ == LocalMap::kFreshPoor ? Attachment::kGuess : Attachment::kUntied;
  node.addition.result.target = newest_.id;
  node.addition.result.covariance = scan.tracked.covariance;
  node.addition.result.T_target_id = from_newest(scan.tracked.T_local_sensor);
  node.addition.result.inlier_ratio = scan.tracked.inlier_ratio;
  local_map_ = LocalMap::kKnown;
  return node;
}

// Odometry slipped, or the robot was kidnapped, or the match is a chance one: which of them is not known. A segment
// begins with the scan, whose edge is as wide as what they say is apart, so that closures decide where it belongs.
TrajectoryNode TrajectoryBuilder::contradict(LocalScan& scan, const Pose2& T_newest_node, const MatchedEdge& match) {
  const auto from_newest_node = [&](const Pose2& T_anchor_node) {
    return from_newest(anchor_.T_local_sensor * T_anchor_node);
  };
  const Pose2 apart = between(T_newest_node, from_newest_node(match.T_anchor_node));
  const bool is_telling = scan.tracked.inlier_ratio >= LocalSlamTuning::kTellingInliers;
  const Pose2 chosen = is_telling ? from_newest_node(match.T_anchor_node_weighed) : T_newest_node;
  const double distance2 = apart.translation().squaredNorm();
  const Eigen::Vector3d far_apart(distance2, distance2, apart.theta * apart.theta);
  const Eigen::Matrix3d covariance = least_contradiction() + Eigen::Matrix3d(far_apart.asDiagonal());
  TrajectoryNode node;
  node.attachment = is_telling ? Attachment::kUntied : Attachment::kGuess;
  node.addition.begins_segment = true;
  node.addition.from = newest_.id;
  node.addition.T_from_node = chosen;
  node.addition.edges = {wide_edge(newest_.id, chosen, covariance, scan)};
  begin_local_map(scan, newest_.T_local_sensor * chosen);
  scan.tracked.rejection = Rejection::kContradictsOdometry;
  node.addition.result.target = next_id_;
  node.addition.result.covariance = covariance;
  node.addition.result.inlier_ratio = scan.tracked.inlier_ratio;
  ++counts_.contradictions;
  return node;
}

Edge TrajectoryBuilder::wide_edge(std::uint64_t target, const Pose2& T_target_node, const Eigen::Matrix3d& covariance,
                                  const LocalScan& scan) const {
  return {0, target, next_id_, {scan.cloud.time, next_id_, T_target_node, covariance, ConstraintType::kOdometry}};
}

}  // namespace oort
