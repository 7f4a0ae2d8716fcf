// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/local_slam/incremental_graph_builder.hpp"
#include "oort/map/node_addition.hpp"
#include "oort/map/renumbering.hpp"
#include "oort/matching/rejection.hpp"
#include "oort/odometry/odometry_monitor.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// A scan and where it is.
struct LocalScan {
  PointCloud cloud;
  Pose2 T_odom_base_measured;  ///< as odometry has it
  Pose2 T_odom_base;           ///< with the corrections of every motion so far
  Pose2 T_odom_sensor;         ///< the same
  /// Of its motion since the scan before, along the axes of the frame before, where no odometry tells of it.
  std::optional<Eigen::Matrix3d> motion_covariance;
  TrackedScan tracked;  ///< its pose is odometry's as long as was_tracked is false
  bool was_tracked = false;
  bool missed = false;  ///< nothing that it shows says where it is
  bool is_node = false;
  bool view_grew = false;          ///< another laser's scan joined it for the first time
  bool odometry_is_wrong = false;  ///< where it was doubted: a match that sees all directions says otherwise
};

/// How a node's segment is tied to the nodes before.
enum class Attachment {
  kTied,    ///< by odometry and scans
  kUntied,  ///< the motion to it is not known
  kGuess,   ///< and where it was put is little more than a guess
};

/// A node of the trajectory, and how well its place is known.
struct TrajectoryNode {
  NodeAddition addition;
  Attachment attachment = Attachment::kTied;
};

/// Where a session begins on a map that is there.
struct SessionStart {
  Pose2 T_map_sensor;
  std::uint64_t nearest_node = 0;
  Pose2 T_nearest_sensor;
};

/// Counts of the trajectory since it was made.
struct TrajectoryCounts {
  std::uint64_t scans_matched = 0;
  std::uint64_t nodes = 0;
  std::uint64_t odometry_edges = 0;  ///< nodes whose match was rejected
  RejectionCounts match_rejections;  ///< of nodes
  std::uint64_t contradictions = 0;  ///< segments begun as odometry and scans disagreed
};

/// Follows the sensor along its trajectory: matches scans with the local map, links node to node, and decides
/// when the local map no longer fits. It knows the newest node and the last one whose match was accepted, nothing
/// of the map's solution.
///
/// A fresh local map begins: with the first scan of a map, of a session, and after a pause; where the tracker itself
/// gives up; where matches stay poor; where odometry and a match contradict each other; and after some nodes in a row
/// that only odometry placed.
class TrajectoryBuilder {
 public:
  explicit TrajectoryBuilder(const Parameters& parameters);

  /// The next scan is the first of an empty map.
  void begin_map();
  /// The next scan begins a segment on a map of so many nodes.
  void begin_session(const SessionStart& start, std::uint64_t node_count);
  /// The next scan begins a segment whose edge to the newest node is very uncertain.
  void interrupt();

  /// The map's older nodes were reduced.
  void renumber(const Renumbering& nodes);

  bool begins_map() const { return begin_ == Begin::kMap; }
  /// Whether there is a newest node that scans are relative to.
  bool is_going_on() const { return begin_ == Begin::kNot; }
  std::uint64_t newest_node() const { return newest_.id; }
  const Pose2& T_odom_base_newest() const { return newest_.T_odom_base; }
  double newest_time() const { return newest_.time; }
  /// The newest node to a pose of the local map.
  Pose2 from_newest(const Pose2& T_local_sensor) const { return between(newest_.T_local_sensor, T_local_sensor); }

  /// Places a scan by matching it with the local map. Where odometry is doubted, the scan's odometry becomes what the
  /// match makes of the hypotheses on the base's motion since the last scan; if it speaks against odometry, odometry is
  /// doubted in the edge that the motion takes part in. Without odometry, matches take its place.
  void track(LocalScan& scan, const MotionHypotheses& hypotheses, const Pose2& T_base_sensor);
  /// Places a scan by odometry alone.
  void extrapolate(LocalScan& scan) const;
  /// Makes the tracked scan a node: by its match where it may be trusted, else by odometry.
  TrajectoryNode add_node(LocalScan& scan);

  const IncrementalGraphBuilder& matcher() const { return matcher_; }
  const TrajectoryCounts& counts() const { return counts_; }

 private:
  /// What the next node begins.
  enum class Begin { kNot, kMap, kSession, kAfterPause };
  enum class LocalMap {
    kKnown,      ///< nodes are on it
    kFresh,      ///< no node yet is on the local map that scans are matched with
    kFreshPoor,  ///< the same, as too many matches with the last one were poor
  };
  struct Placed {
    std::uint64_t id = 0;
    double time = 0.0;  // [s]
    Pose2 T_local_sensor;
    Pose2 T_odom_sensor;
    Pose2 T_odom_base;
  };

  void forget();
  void settle_odometry(LocalScan& scan, const MotionHypotheses& hypotheses, const Pose2& T_odom_base_before,
                       const Pose2& T_base_sensor);
  void doubt(double sigma, double sigma_theta);
  void follow_match(LocalScan& scan, const Pose2& T_base_sensor) const;
  void begin_local_map(LocalScan& scan, const Pose2& T_local_sensor);
  void restart_if_poor(LocalScan& scan);
  void restart_if_rejected(const LocalScan& scan, bool matched);
  TrajectoryNode begin_segment(LocalScan& scan);
  TrajectoryNode extend(LocalScan& scan);
  TrajectoryNode contradict(LocalScan& scan, const Pose2& T_newest_node, const MatchedEdge& match);
  Edge wide_edge(std::uint64_t target, const Pose2& T_target_node, const Eigen::Matrix3d& covariance,
                 const LocalScan& scan) const;

  Parameters parameters_;
  IncrementalGraphBuilder matcher_;
  TrajectoryCounts counts_;
  Begin begin_ = Begin::kMap;
  SessionStart session_;
  LocalMap local_map_ = LocalMap::kKnown;
  std::uint64_t next_id_ = 0;
  Placed newest_;                                                 // the newest node
  Placed anchor_;                                                 // the newest node whose match was accepted
  Pose2 T_odom_sensor_tracked_;                                   // when the matcher was last asked,
  Pose2 T_local_sensor_tracked_;                                  // and what it said
  Eigen::Matrix3d doubt_since_newest_ = Eigen::Matrix3d::Zero();  // of odometry, beyond its model
  Eigen::Matrix3d doubt_since_anchor_ = Eigen::Matrix3d::Zero();
  int rejections_in_a_row_ = 0;
  int poor_in_a_row_ = 0;
};

}  // namespace oort
