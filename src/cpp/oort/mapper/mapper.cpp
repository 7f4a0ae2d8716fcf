// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/mapper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/geometry/work_meter.hpp"
#include "oort/maintenance/lifelong_tuning.hpp"
#include "oort/maintenance/prune.hpp"
#include "oort/maintenance/tied_segments.hpp"
#include "oort/map/locations.hpp"
#include "oort/map/map_check.hpp"
#include "oort/mapper/tuning.hpp"
#include "oort/parameters/table.hpp"

namespace oort {
namespace {

Parameters checked(const Parameters& parameters) {
  check_parameters(parameters);
  return parameters;
}

/// The same for the nodes that came since, too: of so many.
Renumbering with_newer(Renumbering nodes, std::uint64_t count) {
  while (nodes.carrier.size() < count) {
    nodes.kept.push_back(true);
    nodes.carrier.push_back(nodes.size++);
    nodes.T_carrier_node.emplace_back();
  }
  return nodes;
}

}  // namespace

Mapper::Mapper(const Parameters& parameters, const Pose2& T_base_sensor)
    : parameters_(checked(parameters)),
      local_(parameters_),
      lane_(std::make_unique<GlobalLane>(parameters_, parameters_.global_slam_thread)) {
  mount_sensor(T_base_sensor);
}

ScanResult Mapper::add_scan(const LaserScan& scan, const Pose2& T_odom_base, const Sweep& sweep_of_base) {
  if (local_.begins_map() && map_.node_count() > 0) {
    throw StateError("Mapper.add_scan: the map was loaded; call Mapper.begin_session before the first scan");
  }
  renumbering_.reset();
  std::vector<Correction> due;
  {
    const WallClock clock(work_seconds_.waiting);
    due = lane_->take_due();
  }
  const bool corrected = take_effect(due);
  LocalSlam::Result local;
  {
    const WorkClock clock(work_seconds_.tracking);
    local = local_.add_scan(scan, T_odom_base, sweep_of_base);
  }
  if (local.node) add(*local.node);
  count_tracking(tracking_.update(local_.last_scan().missed));
  ScanResult told = result(local.outcome);
  told.corrected = corrected;
  std::vector<NodeAddition> nodes;
  if (local.node) nodes.push_back(std::move(local.node->addition));
  std::optional<std::vector<Location>> places;
  if (std::exchange(places_changed_, false)) places = map().locations;
  lane_->advance(std::move(nodes), std::move(places), work_granted(scan.time));
  return told;
}

void Mapper::request_dock_closure() {
  if (!has_pose()) {
    throw StateError(
        "Mapper.notify_docked: no scan has been mapped yet, so there is nothing to link; drive and scan first");
  }
  const bool parked = dock_request_ && is_parked_at(dock_request_->node);
  if (parked && (dock_request_->open > 0 || dock_request_->found)) return;
  std::vector<NodeAddition> nodes;
  if (!parked) {
    if (std::optional<TrajectoryNode> node = local_.make_node()) {
      add(*node);
      nodes.push_back(std::move(node->addition));
    }
  }
  const std::size_t open = dock_request_ ? dock_request_->open : 0;
  dock_request_ = DockRequest{local_.newest_node(), open + 1, false};
  lane_->request_dock(std::move(nodes), map().locations);
}

std::optional<bool> Mapper::dock_closure_found() const {
  if (!dock_request_ || dock_request_->open > 0) return std::nullopt;
  return dock_request_->found;
}

bool Mapper::notify_docked() {
  renumbering_.reset();
  request_dock_closure();
  take_effect(lane_->settle());
  take_effect({lane_->slam().link_docks()});
  return dock_closure_found().value_or(false);
}

void Mapper::begin_session(const Pose2& T_map_sensor) {
  check_reach(T_map_sensor, "Mapper.begin_session: the start pose");
  renumbering_.reset();
  take_effect(lane_->settle());
  take_effect({lane_->slam().link_docks()});  // while nodes have the ids that it was asked of
  dock_request_.reset();
  prune();
  lane_->slam().begin_session();
  session_begin_ = map_.node_count();
  if (map_.node_count() == 0) {
    local_.begin_map();
    return;
  }
  const std::uint64_t nearest = nearest_node(map().graph, T_map_sensor.translation());
  local_.begin_session({T_map_sensor, nearest, between(map().graph.nodes[nearest].pose, T_map_sensor)},
                       map_.node_count());
}

void Mapper::prune() {
  if (parameters_.keep_views == 0) return;
  const PruneOptions options{static_cast<unsigned>(parameters_.keep_views), LifelongTuning::kMinPrunedShare};
  const std::optional<Pruned> pruned = oort::prune(map(), options);
  if (!pruned) return;
  use(pruned->map);
  tracking_ = TrackingMonitor();  // it counts nodes
  note(pruned->nodes);
}

void Mapper::note(const Renumbering& nodes) {
  renumbering_ = renumbering_ ? *renumbering_ * nodes : nodes;
}

/// Global SLAM reduced the nodes that it knew.
void Mapper::reduce(const Pruned& reduced) {
  const Renumbering all = with_newer(reduced.nodes, map_.node_count());
  map_.reduce(reduced.map, reduced.nodes);
  local_.renumber(reduced.nodes);
  tracking_.renumber(reduced.nodes);
  session_begin_ = reduced.nodes.left_before(session_begin_);
  if (dock_request_) dock_request_->node = reduced.nodes.of(dock_request_->node);
  note(all);
}

void Mapper::finish() {
  renumbering_.reset();
  take_effect(lane_->settle());
  const bool cleaned = remove_body();
  take_effect({lane_->slam().finish()});
  if (cleaned) lane_->slam().forget_submaps();
}

/// Takes the robot's own body out of the clouds of this session from before it was known. Whether there was any.
bool Mapper::remove_body() {
  if (!local_.lasers().main().knows_body()) return false;
  bool cleaned = false;
  for (std::uint64_t k = session_begin_; k < map_.node_count(); ++k) {
    PointCloud cloud = map().clouds[k];
    if (!local_.lasers().main().remove_body_from(cloud)) continue;
    map_.edit().clouds.set(k, cloud);
    lane_->slam().replace_cloud(k, map().clouds.shared(k));
    cleaned = true;
  }
  return cleaned;
}

void Mapper::set_map(const Map& map) {
  const std::optional<std::string> defect = find_defect(map);
  if (defect) throw InputError("Mapper.set_map: this map cannot be used: " + *defect);
  lane_->settle();
  use(map);
  local_.begin_map();
}

void Mapper::use(const Map& map) {
  lane_->slam().set_map(map);
  map_.set_map(lane_->slam().map());
  global_counts_ = lane_->slam().counts();
  session_begin_ = map_.node_count();
  dock_request_.reset();
}

Pose2 Mapper::sensor_pose() const {
  if (!has_pose()) throw StateError("Mapper.sensor_pose: no scan has been mapped yet");
  return map().graph.nodes[local_.newest_node()].pose * local_.T_newest_sensor();
}

Pose2 Mapper::T_map_odom() const {
  return sensor_pose() * inverse(local_.T_odom_sensor_measured());
}

void Mapper::create_location(const std::string& name_space, const std::string& id, const Pose2& T_map_location) {
  oort::create_location(map_.edit(), name_space, id, T_map_location);
  places_changed_ = true;
}

void Mapper::create_points(const std::vector<std::string>& name_spaces, const std::vector<Eigen::Vector2d>& points,
                           const std::vector<std::string>& ids) {
  oort::create_points(map_.edit(), name_spaces, points, ids);
  places_changed_ = true;
}

bool Mapper::delete_location(const std::string& name_space, const std::string& id) {
  places_changed_ = true;
  return oort::delete_location(map_.edit(), name_space, id);
}

std::optional<Pose2> Mapper::locate(const std::string& name_space, const std::string& id) const {
  return oort::locate(map(), name_space, id);
}

MapperStatistics Mapper::statistics() const {
  const OdometryMonitor& odometry = local_.odometry_monitor();
  return {local_.counts(),
          local_.trajectory_counts(),
          tracking_counts_,
          global_counts_,
          odometry.fault_count(),
          odometry.faults(),
          local_.odometry().way_scale(),
          local_.odometry().turn_scale(),
          local_.lasers().findings()};
}

WorkSeconds Mapper::work_seconds() const {
  WorkSeconds seconds = lane_->work_seconds();
  seconds.tracking = work_seconds_.tracking;
  seconds.waiting = work_seconds_.waiting;
  return seconds;
}

void Mapper::keep_closure_attempts(std::size_t capacity) {
  take_effect(lane_->settle());
  lane_->slam().closure_log().set_capacity(capacity);
}

const ClosureLog& Mapper::closure_attempts() const {
  lane_->wait_for_piece();
  return lane_->slam().closure_log();
}

void Mapper::take(const SegmentFinding& finding) {
  if (finding.withdrawn) map_.withdraw_ties(finding.nodes);
  if (finding.begins_segment) map_.begin_segment(finding.nodes.front().begin);
  if (finding.disproved) map_.loosen(finding.nodes);
  if (finding.trusted) tracking_.trust(*finding.trusted);
  if (finding.withdrawn) tracking_.add_untied(finding.nodes.front().begin, false);
}

/// Whether that changes the map.
bool Mapper::take_effect(const std::vector<Correction>& corrections) {
  bool solved = false, closed = false;
  for (const Correction& correction : corrections) {
    if (correction.reduced) reduce(*correction.reduced);
    for (const SegmentFinding& finding : correction.segments) take(finding);
    for (const Closure& closure : correction.closures) map_.add(closure);
    if (correction.solution) map_.apply(*correction.solution);
    if (correction.clouds) map_.edit().clouds = *correction.clouds;
    solved = solved || correction.solution.has_value();
    closed = closed || !correction.closures.empty();
    global_counts_ = correction.counts;
    for (const bool found : correction.docked) {
      --dock_request_->open;
      dock_request_->found = found;
    }
  }
  if (solved && tracking_.is_untied()) {
    tracking_.look_for_tie(closed_parts(map().graph, map_.segments()).back());
  }
  return solved || closed || renumbering_.has_value();
}

void Mapper::add(const TrajectoryNode& node) {
  if (node.attachment != Attachment::kTied) {
    tracking_.add_untied(map_.node_count(), node.attachment == Attachment::kGuess);
  }
  map_.add(node.addition);
}

/// Whether the sensor is still where that node, the newest, was made.
bool Mapper::is_parked_at(std::uint64_t node) const {
  const Pose2 moved = local_.T_newest_sensor();
  return local_.newest_node() == node && moved.translation().norm() < MapperTuning::kParkedDistance &&
         std::abs(moved.theta) < MapperTuning::kParkedAngle;
}

void Mapper::count_tracking(TrackingState state) {
  if (state != tracking_state_) ++tracking_counts_.changes;
  tracking_state_ = state;
  ++(state == TrackingState::kTracking ? tracking_counts_.tracking
     : state == TrackingState::kLost   ? tracking_counts_.lost
                                       : tracking_counts_.uncertain);
}

/// What global SLAM may do until the next scan, by the shorter of the last two intervals: a pause is no credit.
std::uint64_t Mapper::work_granted(double time) {
  const double interval = std::clamp(time - last_time_, MapperTuning::kMinInterval, MapperTuning::kMaxInterval);
  const double shorter = last_interval_ > 0.0 ? std::min(interval, last_interval_) : MapperTuning::kMinInterval;
  last_time_ = time;
  last_interval_ = interval;
  return static_cast<std::uint64_t>(MapperTuning::kGlobalShare * WorkMeter::kUnitsPerSecond * shorter);
}

ScanResult Mapper::result(ScanOutcome outcome) const {
  const LocalScan& scan = local_.last_scan();
  ScanResult result;
  result.tracking = tracking_state_;
  result.outcome = outcome;
  result.inlier_ratio = scan.tracked.inlier_ratio;
  result.was_tracked = scan.was_tracked;
  result.rejection = scan.tracked.rejection;
  if (!local_.has_pose()) return result;
  result.node_id = local_.newest_node();
  result.T_node_sensor = local_.T_newest_sensor();
  const Pose2 T_map_sensor = sensor_pose();
  result.T_map_base = T_map_sensor * inverse(local_.T_base_sensor());
  result.T_map_odom = T_map_odom();
  result.covariance =
      rotate_covariance(scan.tracked.covariance, T_map_sensor.theta - scan.tracked.T_local_sensor.theta);
  return result;
}

}  // namespace oort
