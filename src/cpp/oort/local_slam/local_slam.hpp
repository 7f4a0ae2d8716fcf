// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/sweep.hpp"
#include "oort/local_slam/trajectory_builder.hpp"
#include "oort/odometry/constant_velocity.hpp"
#include "oort/odometry/odometry_monitor.hpp"
#include "oort/parameters/parameters.hpp"
#include "oort/sensor/laser_rig.hpp"

namespace oort {

enum class ScanOutcome {
  kNode,     ///< the scan made a node
  kLocated,  ///< it was located relative to the last node
  kSkipped,  ///< it had too few returns, or was the scan before once more: located by odometry alone, if there is a
             ///< node
};

/// As reports, messages and Python have it.
std::string_view to_string(ScanOutcome outcome);

struct LocalCounts {
  std::uint64_t scans = 0;
  std::uint64_t scans_too_small = 0;  ///< fewer returns than min_pointcloud_size, or repeated: extrapolated by odometry
};

/// The local lane: a scan with odometry in (or without: parameter use_odometry), its pose relative to the newest node
/// out. The work for a scan is bounded by constants and waits for nothing; the map's solution has no bearing on it.
class LocalSlam {
 public:
  struct Result {
    ScanOutcome outcome = ScanOutcome::kSkipped;
    std::optional<TrajectoryNode> node;  ///< that the scan made
  };

  explicit LocalSlam(const Parameters& parameters);

  /// Throws StateError once scans are being mapped, InputError if the pose is not finite.
  void mount_sensor(const Pose2& T_base_sensor);
  const Pose2& T_base_sensor() const { return lasers_.T_base_main(); }

  void begin_map();
  void begin_session(const SessionStart& start, std::uint64_t node_count);
  void interrupt();
  /// The map's older nodes were reduced.
  void renumber(const Renumbering& nodes) { trajectory_.renumber(nodes); }

  /// Throws InputError if the scan's limits, the pose or the motion are not finite; nothing changes then.
  Result add_scan(const LaserScan& scan, const Pose2& T_odom_base, const Sweep& sweep_of_base);

  /// Takes a scan of another laser, which joins the next one of the main laser. Throws as add_scan().
  void remember(const Pose2& T_base_sensor, const LaserScan& scan, const Pose2& T_odom_base,
                const Sweep& sweep_of_base);

  /// Makes the latest scan a node if it is none and has returns enough.
  std::optional<TrajectoryNode> make_node();

  /// Whether the next scan begins a map.
  bool begins_map() const { return trajectory_.begins_map(); }
  /// Whether the latest scan is located relative to a node.
  bool has_pose() const { return last_.has_value() && trajectory_.is_going_on(); }
  /// The latest scan. There must be one.
  const LocalScan& last_scan() const { return *last_; }
  /// Where the latest scan was taken, as odometry has it.
  Pose2 T_odom_sensor_measured() const { return last_->T_odom_base_measured * T_base_sensor(); }
  std::uint64_t newest_node() const { return trajectory_.newest_node(); }
  Pose2 T_newest_sensor() const { return trajectory_.from_newest(last_->tracked.T_local_sensor); }

  const LaserRig& lasers() const { return lasers_; }
  const LocalCounts& counts() const { return counts_; }
  const LearnedOdometry& odometry() const { return trajectory_.matcher().odometry(); }
  const OdometryMonitor& odometry_monitor() const { return monitor_; }
  const TrajectoryCounts& trajectory_counts() const { return trajectory_.counts(); }

 private:
  void forget_motion();
  MotionHypotheses expect(LocalScan& scan);
  void predict(LocalScan& scan);
  bool has_returns(const LocalScan& scan) const;
  bool is_due(const LocalScan& scan) const;
  bool has_moved_unnoticed(const LocalScan& scan) const;

  Parameters parameters_;
  LaserRig lasers_;
  OdometryMonitor monitor_;
  ConstantVelocity velocity_;  // in the place of odometry
  TrajectoryBuilder trajectory_;
  std::optional<LocalScan> last_;
  LocalCounts counts_;
};

}  // namespace oort
