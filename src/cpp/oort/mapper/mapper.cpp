// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/mapper.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/map/map_check.hpp"
#include "oort/matching/frsm_adapter.hpp"
#include "oort/parameters/table.hpp"

namespace oort {
namespace {

// Variance of x, y and theta of a scan that nothing was matched with: FRSM's value for its first scan.
constexpr double kUnmatchedVariance = 0.1;

// So many nodes in a row that only odometry places, and the scan matcher starts afresh.
constexpr int kMaxRefusals = 5;

Eigen::Matrix3d inflated_covariance(double scale) {
  return kUnmatchedVariance * scale * scale * Eigen::Matrix3d::Identity();
}

Parameters checked(const Parameters& parameters) {
  check_parameters(parameters);
  return parameters;
}

}  // namespace

Mapper::Mapper(const Parameters& parameters, const Pose2& T_base_sensor)
    : parameters_(checked(parameters)), incremental_(parameters_), loops_(parameters_), docks_(parameters_) {
  mount_sensor(T_base_sensor);
}

void Mapper::mount_sensor(const Pose2& T_base_sensor) {
  if (!is_finite(T_base_sensor)) throw InputError("the sensor's pose on the base is not finite; check the transform");
  if (last_scan_) throw StateError("the sensor's place on the base cannot change while scans are being mapped");
  T_base_sensor_ = T_base_sensor;
}

ScanResult Mapper::add_scan(const LaserScan& scan, const Pose2& T_odom_base, const Sweep& sweep_of_base) {
  if (!is_finite(T_odom_base) || !std::isfinite(scan.time)) {
    throw InputError("scan: its time or odometry pose is not finite; check the transform odom -> base");
  }
  check_reach(T_odom_base, "scan: its odometry pose");
  if (next_link_ == NextLink::kNone && !map_.graph.nodes.empty()) {
    throw StateError("the map was loaded: call begin_session() before the first scan");
  }
  LastScan now;
  now.cloud = cloud_of(scan, sweep_of_base);
  now.T_odom_base_measured = T_odom_base;
  now.T_odom_base = T_odom_base;
  if (last_scan_ && incremental_.learns_odometry()) {
    now.T_odom_base =
        last_scan_->T_odom_base * incremental_.corrected(between(last_scan_->T_odom_base_measured, T_odom_base));
  }
  now.T_odom_sensor = now.T_odom_base * T_base_sensor_;
  ++statistics_.scans;
  const std::uint64_t solves_before = statistics_.solves;

  const bool has_points = count_returns(now.cloud) >= static_cast<std::size_t>(parameters_.min_pointcloud_size);
  bool due = has_points && is_due(now);
  if (has_points && (due || parameters_.incremental_graph_builder.match_every_scan)) {
    track(now);
  } else {
    carry(now);
  }
  if (!has_points) ++statistics_.scans_too_small;
  now.missed = now.missed || !has_points;
  due = due || has_moved_unnoticed(now);

  if (due) make_node(now);
  last_scan_ = std::move(now);
  const bool tried_closures = loops_.has_work();
  close_loops();
  count_tracking(tracking_.update(last_scan_->missed));
  ScanResult told = result(*last_scan_, due          ? ScanOutcome::kNode
                                        : has_points ? ScanOutcome::kCarried
                                                     : ScanOutcome::kSkipped);
  told.tried_closures = tried_closures;
  told.solved = statistics_.solves > solves_before;
  return told;
}

bool Mapper::notify_docked() {
  if (!has_pose()) {
    throw StateError("notify_docked: no scan has been mapped yet, so there is nothing to link; drive and scan first");
  }
  std::uint64_t query = map_.graph.nodes.back().id;
  const bool has_points = count_returns(last_scan_->cloud) >= static_cast<std::size_t>(parameters_.min_pointcloud_size);
  if (!last_scan_->is_node && has_points) {
    if (!last_scan_->was_tracked) track(*last_scan_);
    query = make_node(*last_scan_);
  }
  std::optional<Closure> closure;
  {
    const WorkClock clock(work_seconds_.matching);
    closure = docks_.find(map_, chains_, query, statistics_.docks);
  }
  if (!closure) return false;
  add_closure(*closure);
  solve_anew(kIterationsWhileMapping);
  return true;
}

void Mapper::begin_session(const Pose2& T_map_sensor) {
  check_reach(T_map_sensor, "the start pose of a session");
  T_map_start_ = T_map_sensor;
  next_link_ = map_.graph.nodes.empty() ? NextLink::kNone : NextLink::kSession;
  last_scan_.reset();
  // A session on the map in memory is the same as one on that map loaded: nothing learned, nothing half done.
  incremental_ = IncrementalGraphBuilder(parameters_);
  loops_ = LoopClosureBuilder(parameters_);
}

void Mapper::resume_from_paused() {
  if (next_link_ == NextLink::kChain) next_link_ = NextLink::kPaused;
}

void Mapper::set_map(Map map) {
  const std::optional<std::string> defect = find_defect(map);
  if (defect) throw InputError("this map cannot be used: " + *defect);
  map_ = std::move(map);
  make_dock_closures_firm(map_, parameters_.dock_graph_builder.closure_firmness);
  chains_ = Chains::of_map(map_);
  loops_ = LoopClosureBuilder(parameters_);  // the submaps it remembers are of the old map
  next_edge_id_ = next_edge_id(map_.graph);
  next_link_ = NextLink::kNone;
  last_scan_.reset();
  pending_closures_ = 0;
  nodes_at_last_solve_ = map_.graph.nodes.size();
  is_on_.clear();
  look_at_solution();
}

// Odometry's own scales of way and turn are off by little over the length of a scan: the motion is taken as measured.
PointCloud Mapper::cloud_of(const LaserScan& scan, const Sweep& sweep_of_base) const {
  PointCloud cloud = to_point_cloud(scan);
  if (!parameters_.motion_compensation) return cloud;
  return compensate_motion(std::move(cloud), sweep_of_sensor(sweep_of_base, T_base_sensor_));
}

bool Mapper::is_due(const LastScan& scan) const {
  if (next_link_ != NextLink::kChain) return true;
  const double since = std::abs(scan.cloud.time - map_.clouds.back().time);  // a clock may have been set back
  if (parameters_.time_update > 0.0 && since >= parameters_.time_update) return true;
  const Pose2 moved = between(T_odom_base_node_, scan.T_odom_base);
  return moved.translation().norm() >= parameters_.linear_update || std::abs(moved.theta) >= parameters_.angular_update;
}

void Mapper::track(LastScan& scan) {
  const WorkClock clock(work_seconds_.tracking);
  const bool is_first = next_link_ != NextLink::kChain;
  Pose2 T_previous_sensor = between(T_odom_sensor_tracked_, scan.T_odom_sensor);
  if (is_first) {  // the first scan of a segment has nothing to be matched with
    Pose2 T_local_start;
    if (next_link_ == NextLink::kPaused) T_local_start = T_local_sensor_tracked_ * T_previous_sensor;
    if (next_link_ == NextLink::kSession) T_local_start = T_map_start_;
    incremental_.begin(T_local_start);
    fresh_local_map_ = false;
    T_previous_sensor = Pose2{};
  }
  scan.tracked = incremental_.track(returns_of(scan.cloud), scan.cloud.time, T_previous_sensor);
  scan.was_tracked = true;
  scan.missed = !is_first && !incremental_.is_placed(scan.tracked);
  leave_poor_local_map(scan);
  if (scan.tracked.restarted) fresh_local_map_ = true;
  T_odom_sensor_tracked_ = scan.T_odom_sensor;
  T_local_sensor_tracked_ = scan.tracked.T_local_sensor;
  if (scan.tracked.usable()) ++statistics_.scans_matched;
}

void Mapper::carry(LastScan& scan) const {
  scan.tracked.T_local_sensor = T_local_sensor_tracked_ * between(T_odom_sensor_tracked_, scan.T_odom_sensor);
}

std::uint64_t Mapper::make_node(LastScan& scan) {
  Node node;
  node.id = map_.graph.nodes.size();
  scan.cloud.id = node.id;
  ChainStep step = ChainStep::kFresh;
  if (next_link_ == NextLink::kChain) {
    step = link_to_chain(scan, node);
  } else {
    const LinkParameters p = link_parameters(parameters_.incremental_graph_builder);
    map_.incremental_results.push_back(
        {node.id, node.id, scan.tracked.T_local_sensor, inflated_covariance(p.scanmatch_cov_scale), Pose2{}, 0.0});
    if (next_link_ == NextLink::kPaused) {
      const Node& last = map_.graph.nodes.back();
      const Pose2 T_last_node = between(T_odom_sensor_node_, scan.T_odom_sensor);
      node.pose = last.pose * T_last_node;
      link_loosely(last.id, T_last_node, inflated_covariance(p.inflate_scanmatch_cov_scale), node, scan.cloud.time);
    } else if (next_link_ == NextLink::kSession) {
      node.pose = T_map_start_;
      const std::uint64_t target = nearest_node(node.pose.translation());
      link_loosely(target, between(map_.graph.nodes[target].pose, node.pose),
                   inflated_covariance(p.resume_scanmatch_cov_scale), node, scan.cloud.time);
    }
    if (next_link_ != NextLink::kNone) tracking_.hang_loosely(node.id, false);
  }
  map_.graph.nodes.push_back(node);
  chains_.add(step == ChainStep::kFresh, step != ChainStep::kOdometry, scan.tracked.T_local_sensor);
  if (step != ChainStep::kOdometry) {
    anchor_ = {node.id, scan.T_odom_sensor};
    refusals_in_a_row_ = 0;
  } else if (++refusals_in_a_row_ >=
             kMaxRefusals) {  // the local map does not fit what is seen any more: make a new one
    incremental_.begin(scan.tracked.T_local_sensor);
    fresh_local_map_ = true;
  }
  map_.clouds.push_back(scan.cloud);
  ++statistics_.nodes;
  scan.is_node = true;
  next_link_ = NextLink::kChain;
  T_odom_sensor_node_ = scan.T_odom_sensor;
  T_odom_base_node_ = scan.T_odom_base;
  T_local_sensor_tracked_ = scan.tracked.T_local_sensor;  // linking may have corrected it
  {
    const WorkClock clock(work_seconds_.candidates);
    loops_.look(map_, chains_, node.id);
  }
  return node.id;
}

Mapper::ChainStep Mapper::link_to_chain(LastScan& scan, Node& node) {
  const Node& previous = map_.graph.nodes.back();
  const Pose2 T_previous_node = between(T_odom_sensor_node_, scan.T_odom_sensor);
  const auto add_edge = [&](std::uint64_t from, const Pose2& pose, const Eigen::Matrix3d& covariance,
                            ConstraintType type) {
    map_.graph.edges.push_back({next_edge_id_++, from, node.id, {scan.cloud.time, node.id, pose, covariance, type}});
  };
  // What is matched after a gap says where the node is from before the gap, not from the nodes within.
  const bool after_gap = anchor_.node != previous.id;
  MatchLink match =
      incremental_.link(chains_.local_pose(anchor_.node), between(anchor_.T_odom_sensor, scan.T_odom_sensor),
                        scan.tracked, after_gap && incremental_.knows_odometry());
  if (match.contradicts_odometry && !fresh_local_map_) {
    return begin_contradicted_chain(scan, node, T_previous_node, match);
  }
  if (fresh_local_map_) match.rejection = Rejection::kRestarted;  // the anchor is on another map than the scan
  const bool believed = match.rejection == Rejection::kNone;
  if (!believed || after_gap) {
    Eigen::Matrix3d covariance = incremental_.odometry_covariance(T_previous_node, match.rejection);
    if (left_poor_local_map_) covariance += least_contradiction();
    if (fresh_local_map_) tracking_.hang_loosely(node.id, left_poor_local_map_);
    add_edge(previous.id, T_previous_node, covariance, ConstraintType::kOdometry);
  }
  if (believed) {
    add_edge(anchor_.node, match.T_anchor_node, match.covariance, ConstraintType::kLaser);
    node.pose = map_.graph.nodes[anchor_.node].pose * match.T_anchor_node;
  } else {
    ++statistics_.odometry_links;
    ++statistics_.match_rejections[match.rejection];
    scan.missed = true;
    node.pose = previous.pose * T_previous_node;
  }
  if (!believed && !fresh_local_map_) {
    scan.tracked.T_local_sensor = chains_.local_pose(previous.id) * T_previous_node;
    incremental_.correct(scan.tracked.T_local_sensor);
  }
  map_.incremental_results.push_back({node.id, previous.id, scan.tracked.T_local_sensor, scan.tracked.covariance,
                                      between(chains_.local_pose(previous.id), scan.tracked.T_local_sensor),
                                      scan.tracked.hit_fraction});
  const ChainStep step = believed ? ChainStep::kMatched : fresh_local_map_ ? ChainStep::kFresh : ChainStep::kOdometry;
  fresh_local_map_ = false;
  left_poor_local_map_ = false;
  return step;
}

void Mapper::link_loosely(std::uint64_t target, const Pose2& T_target_node, const Eigen::Matrix3d& covariance,
                          const Node& node, double time) {
  map_.graph.edges.push_back(
      {next_edge_id_++, target, node.id, {time, node.id, T_target_node, covariance, ConstraintType::kOdometry}});
}

void Mapper::close_loops() {
  std::vector<Closure> closures;
  {
    const WorkClock clock(work_seconds_.matching);
    closures = loops_.work(map_, chains_, statistics_.loops, closure_log_);
  }
  solve_if_worthwhile(add_closures(closures));
}

double Mapper::add_closures(const std::vector<Closure>& closures) {
  double surprise = 0.0;
  for (const Closure& closure : closures) surprise = std::max(surprise, add_closure(closure));
  return surprise;
}

double Mapper::add_closure(const Closure& closure) {
  ++pending_closures_;
  return oort::add_closure(closure, next_edge_id_++, map_);
}

ScanResult Mapper::result(const LastScan& scan, ScanOutcome outcome) const {
  ScanResult result;
  result.tracking = tracking_state_;
  result.outcome = outcome;
  result.hit_fraction = scan.tracked.hit_fraction;
  result.was_tracked = scan.was_tracked;
  result.rejection = scan.tracked.rejection;
  if (next_link_ == NextLink::kChain) {  // else nothing links the scan to any node
    result.node_id = map_.graph.nodes.back().id;
    result.T_node_sensor = between(chains_.local_pose(*result.node_id), scan.tracked.T_local_sensor);
  }
  return result;
}

}  // namespace oort
