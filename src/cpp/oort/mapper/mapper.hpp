// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/sweep.hpp"
#include "oort/local_slam/local_slam.hpp"
#include "oort/local_slam/tracking_state.hpp"
#include "oort/mapper/global_lane.hpp"
#include "oort/mapper/growing_map.hpp"
#include "oort/mapper/statistics.hpp"
#include "oort/mapper/work_clock.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

struct ScanResult {
  ScanOutcome outcome = ScanOutcome::kSkipped;
  std::optional<std::uint64_t> node_id;  ///< the node that the pose is relative to; none before the first node
  Pose2 T_node_sensor;
  Pose2 T_map_base;  ///< at the solution that was in effect when the scan came; as well
  Pose2 T_map_odom;  ///< the same; both the identity without a node
  /// Of T_node_sensor as matched, along the axes of the map; zero where the scan was not matched.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double inlier_ratio = 0.0;
  bool was_tracked = false;                      ///< whether the scan matcher was asked
  Rejection rejection = Rejection::kNotMatched;  ///< of its match by itself
  TrackingState tracking = TrackingState::kTracking;
  bool corrected = false;  ///< whether closures or a solution took effect with this scan
};

/// Turns scans with odometry into a map: nodes and edges, loop and dock closures, solved poses, named places.
///
/// Two lanes: local SLAM places each scan at once; global SLAM looks for loops and solves beside it, in a thread of its
/// own, and its results take effect at scans that follow from counted work alone. Deterministic: the same calls give
/// the same map, with the thread and without. Not thread-safe itself. Nodes are sensor poses, and the first of a new
/// map is its origin.
class Mapper {
 public:
  /// Throws ParameterError if the parameters contradict each other, InputError if the pose is not finite.
  explicit Mapper(const Parameters& parameters, const Pose2& T_base_sensor = {});

  /// Says where the sensor sits on the base, if that was not known before. Throws StateError once scans are being
  /// mapped, InputError if the pose is not finite.
  void mount_sensor(const Pose2& T_base_sensor) { local_.mount_sensor(T_base_sensor); }

  /// Takes the next scan with odometry at its stamp and, for one whose beams were not measured at once, the base's
  /// motion by odometry while it was taken. Throws InputError if the scan's limits, the pose or the motion are not
  /// finite; nothing changes then.
  ScanResult add_scan(const LaserScan& scan, const Pose2& T_odom_base, const Sweep& sweep_of_base = {});

  /// Takes a scan of another laser than the one whose place the mapper was told, known by its own place. What it saw
  /// joins the next scan, if that comes within a quarter of a second. Throws as add_scan().
  void add_scan_of_other(const Pose2& T_base_sensor, const LaserScan& scan, const Pose2& T_odom_base,
                         const Sweep& sweep_of_base = {}) {
    local_.remember(T_base_sensor, scan, T_odom_base, sweep_of_base);
  }

  /// Says that the robot stands at the dock now: makes a node of the last scan and has global SLAM link it to the
  /// dock's node, beside the scans to come; finish() does it at the latest. A robot that did not move since it was
  /// linked is linked already. Throws StateError if there is no scan yet.
  void request_dock_closure();
  /// What came of the last request: whether a closure was found. None without one, or while it is looked for.
  std::optional<bool> dock_closure_found() const;
  /// Does both at once: asks, and waits for global SLAM.
  bool notify_docked();

  /// The next scan begins a new segment at about this pose of the map. A map that shows most of its places more often
  /// than keep_views asks for is pruned first (maintenance/prune.hpp): see take_renumbering().
  void begin_session(const Pose2& T_map_sensor);

  /// What became of the nodes, if the last scan, session or finish() gave them other ids: global SLAM reduced the map
  /// to the views that it needs, or begin_session() did. Tells it once.
  std::optional<Renumbering> take_renumbering() { return std::exchange(renumbering_, std::nullopt); }

  /// The next scan makes a node whose edge to the last one is very uncertain.
  void resume_from_paused() { local_.interrupt(); }

  /// Solves with all that is known, then lets scans that saw the same surfaces agree (refinement.hpp). The map is at
  /// its final solution afterwards; mapping may go on.
  void finish();

  /// The map with all that has taken effect.
  const Map& map() const { return map_.map(); }
  /// Replaces everything by a map from elsewhere. Mapping goes on after begin_session(). Throws InputError, with
  /// nothing changed, if the map contradicts itself.
  void set_map(const Map& map);

  /// Whether the sensor's pose in the map is known.
  bool has_pose() const { return local_.has_pose(); }
  /// The latest scan's pose at the solution in effect. StateError if there is none.
  Pose2 sensor_pose() const;
  /// Where odometry's frame is in the map now. StateError if there is no pose yet.
  Pose2 T_map_odom() const;

  // Named places, as in map/locations.hpp.
  void create_location(const std::string& name_space, const std::string& id, const Pose2& T_map_location);
  void create_points(const std::vector<std::string>& name_spaces, const std::vector<Eigen::Vector2d>& points,
                     const std::vector<std::string>& ids);
  bool delete_location(const std::string& name_space, const std::string& id);
  std::optional<Pose2> locate(const std::string& name_space, const std::string& id) const;

  /// Counts, of the global lane as far as it has taken effect.
  MapperStatistics statistics() const;
  /// What the CPU time since the mapper was made went into. Differs from run to run, and decides nothing.
  WorkSeconds work_seconds() const;

  /// Keeps the latest attempts to close loops, as many as there is room for, for people who tune.
  void keep_closure_attempts(std::size_t capacity);
  const ClosureLog& closure_attempts() const;

 private:
  struct DockRequest {
    std::uint64_t node;
    std::size_t open;  // requests that nothing came of yet
    bool found;        // what came of the last
  };
  void prune();
  void reduce(const Pruned& reduced);
  void note(const Renumbering& nodes);
  void use(const Map& map);
  void take(const SegmentFinding& finding);
  bool take_effect(const std::vector<Correction>& corrections);
  void add(const TrajectoryNode& node);
  bool remove_body();
  bool is_parked_at(std::uint64_t node) const;
  void count_tracking(TrackingState state);
  std::uint64_t work_granted(double time);
  ScanResult result(ScanOutcome outcome) const;

  Parameters parameters_;
  LocalSlam local_;
  GrowingMap map_;
  std::uint64_t session_begin_ = 0;  // its first node
  TrackingMonitor tracking_;
  TrackingState tracking_state_ = TrackingState::kTracking;
  TrackingCounts tracking_counts_;
  GlobalCounts global_counts_;
  std::optional<DockRequest> dock_request_;
  bool places_changed_ = false;  // since global SLAM was told of them
  std::optional<Renumbering> renumbering_;
  WorkSeconds work_seconds_;    // of the local lane
  double last_time_ = 0.0;      // stamp of the last scan [s]
  double last_interval_ = 0.0;  // between it and the one before [s]
  std::unique_ptr<GlobalLane> lane_;
};

}  // namespace oort
