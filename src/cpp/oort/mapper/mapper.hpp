// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/sweep.hpp"
#include "oort/graph/optimizer.hpp"
#include "oort/local_slam/incremental_graph_builder.hpp"
#include "oort/local_slam/tracking_state.hpp"
#include "oort/loop_closure/closure_log.hpp"
#include "oort/loop_closure/dock_graph_builder.hpp"
#include "oort/loop_closure/loop_closure_builder.hpp"
#include "oort/loop_closure/statistics.hpp"
#include "oort/map/chains.hpp"
#include "oort/map/map.hpp"
#include "oort/mapper/work_clock.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

enum class ScanOutcome {
  kNode,     ///< the scan made a node
  kCarried,  ///< it was located relative to the last node
  kSkipped,  ///< it had too few returns: located by odometry alone, if there is a node to be relative to
};

struct ScanResult {
  ScanOutcome outcome = ScanOutcome::kSkipped;
  std::optional<std::uint64_t> node_id;  ///< the node that the pose is relative to; none before the first node
  Pose2 T_node_sensor;
  double hit_fraction = 0.0;
  bool was_tracked = false;                      ///< whether the scan matcher was asked
  Rejection rejection = Rejection::kNotMatched;  ///< of its match by itself
  TrackingState tracking = TrackingState::kTracking;
  bool tried_closures = false;  ///< whether the scan's turn brought work on loop closures
  bool solved = false;          ///< whether the graph was solved
};

/// Turns scans with odometry into a map: nodes and links, loop and dock closures, solved poses, named places.
/// Deterministic; not thread-safe. Nodes are sensor poses, and the first of a new map is its origin.
class Mapper {
 public:
  /// Throws ParameterError if the parameters contradict each other, InputError if the pose is not finite.
  explicit Mapper(const Parameters& parameters, const Pose2& T_base_sensor = {});

  /// Says where the sensor sits on the base, if that was not known before. Throws StateError once scans are being
  /// mapped, InputError if the pose is not finite.
  void mount_sensor(const Pose2& T_base_sensor);

  /// Takes the next scan with odometry at its stamp and, for one whose beams were not measured at once, the base's
  /// motion by odometry while it was taken. Throws InputError if the scan's limits, the pose or the motion are not
  /// finite; nothing changes then.
  ScanResult add_scan(const LaserScan& scan, const Pose2& T_odom_base, const Sweep& sweep_of_base = {});

  /// Says that the robot stands at the dock now: makes a node of the last scan and links it to the dock's node.
  /// Returns whether a closure was found. Throws StateError if there is no scan yet.
  bool notify_docked();

  /// The next scan begins a new chain at about this pose of the map.
  void begin_session(const Pose2& T_map_sensor);

  /// The next scan makes a node whose link to the last one is very uncertain.
  void resume_from_paused();

  /// Solves with all that is known, then lets scans that saw the same surfaces agree (refinement.hpp). The map is at
  /// its final solution afterwards; mapping may go on.
  void finish();

  const Map& map() const { return map_; }
  /// Replaces everything by a map from elsewhere. Mapping goes on after begin_session(). Throws InputError, with
  /// nothing changed, if the map contradicts itself.
  void set_map(Map map);

  /// Whether the sensor's pose in the map is known.
  bool has_pose() const;
  /// The latest scan's pose at the current solution. StateError if there is none.
  Pose2 sensor_pose() const;
  /// Where odometry's frame is in the map now. StateError if there is no pose yet.
  Pose2 T_map_odom() const;

  /// Names a pose of the map; it is kept relative to the nearest node. An old one of the same name is replaced.
  /// StateError without a node, InputError if the pose is not finite.
  void create_location(const std::string& name_space, const std::string& id, const Pose2& T_map_location);
  /// Names points of the map, all relative to the node nearest to their centroid.
  void create_points(const std::vector<std::string>& name_spaces, const std::vector<Eigen::Vector2d>& points,
                     const std::vector<std::string>& ids);
  /// Whether there was such a location.
  bool delete_location(const std::string& name_space, const std::string& id);
  std::optional<Pose2> locate(const std::string& name_space, const std::string& id) const;

  const MapperStatistics& statistics() const { return statistics_; }
  /// What the CPU time since the mapper was made went into. Differs from run to run, and decides nothing.
  const WorkSeconds& work_seconds() const { return work_seconds_; }

  /// Keeps the latest attempts to close loops, as many as there is room for, for people who tune.
  void keep_closure_attempts(std::size_t capacity) { closure_log_.set_capacity(capacity); }
  const ClosureLog& closure_attempts() const { return closure_log_; }

 private:
  /// The latest scan and where it is.
  struct LastScan {
    PointCloud cloud;
    Pose2 T_odom_base_measured;  ///< as odometry has it
    Pose2 T_odom_base;           ///< with the corrections of every motion so far
    Pose2 T_odom_sensor;         ///< the same
    TrackedScan tracked;         // its pose is odometry's as long as was_tracked is false
    bool was_tracked = false;
    bool missed = false;  // nothing that it shows says where it is
    bool is_node = false;
  };
  /// How the next node hangs on what is there.
  enum class NextLink { kNone, kChain, kPaused, kSession };
  /// How a node came to its place on the scan matcher's local map: by its match, by odometry alone, or as the first of
  /// a new local map.
  enum class ChainStep { kMatched, kOdometry, kFresh };
  /// The newest node whose match was believed.
  struct Anchor {
    std::uint64_t node = 0;
    Pose2 T_odom_sensor;
  };

  PointCloud cloud_of(const LaserScan& scan, const Sweep& sweep_of_base) const;
  bool is_due(const LastScan& scan) const;
  bool has_moved_unnoticed(const LastScan& scan) const;
  void track(LastScan& scan);
  void leave_poor_local_map(LastScan& scan);
  void carry(LastScan& scan) const;
  std::uint64_t make_node(LastScan& scan);
  ChainStep link_to_chain(LastScan& scan, Node& node);
  ChainStep begin_contradicted_chain(LastScan& scan, Node& node, const Pose2& T_previous_node, const MatchLink& match);
  static Eigen::Matrix3d least_contradiction();
  void link_loosely(std::uint64_t target, const Pose2& T_target_node, const Eigen::Matrix3d& covariance,
                    const Node& node, double time);
  void close_loops();
  double add_closures(const std::vector<Closure>& closures);
  double add_closure(const Closure& closure);
  static constexpr int kIterationsWhileMapping = 15;
  void solve_if_worthwhile(double surprise);
  void solve_anew(int max_iterations);
  bool solve_newest();
  OptimizerSummary solve(int max_iterations, std::uint64_t first_free_node = 0);
  void look_at_solution();
  void count_tracking(TrackingState state);
  std::uint64_t nearest_node(const Eigen::Vector2d& p_map) const;
  ScanResult result(const LastScan& scan, ScanOutcome outcome) const;

  Parameters parameters_;
  Pose2 T_base_sensor_;
  Map map_;
  Chains chains_;
  IncrementalGraphBuilder incremental_;
  LoopClosureBuilder loops_;
  DockGraphBuilder docks_;
  MapperStatistics statistics_;
  WorkSeconds work_seconds_;
  ClosureLog closure_log_;
  TrackingMonitor tracking_;
  TrackingState tracking_state_ = TrackingState::kTracking;
  std::vector<bool> is_on_;  // each switchable edge, at the last solution

  NextLink next_link_ = NextLink::kNone;
  Pose2 T_map_start_;  // of a session to begin
  std::optional<LastScan> last_scan_;
  Pose2 T_odom_sensor_tracked_;   // when the matcher was last asked,
  Pose2 T_local_sensor_tracked_;  // and what it said
  Anchor anchor_;
  int refusals_in_a_row_ = 0;
  int poor_in_a_row_ = 0;             // scans whose matches had few hits
  bool left_poor_local_map_ = false;  // as there were too many of them
  bool fresh_local_map_ = false;      // no node yet is on the local map that scans are matched with
  Pose2 T_odom_sensor_node_;          // at the newest node
  Pose2 T_odom_base_node_;
  std::uint64_t next_edge_id_ = 0;
  std::uint64_t pending_closures_ = 0;  // since the last solve
  std::uint64_t nodes_at_last_solve_ = 0;
};

}  // namespace oort
