// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <frsm/matcher.hpp>
#include <memory>
#include <optional>
#include <string_view>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/sweep.hpp"
#include "oort/localization/reference_map.hpp"
#include "oort/localization/relocalizer.hpp"
#include "oort/localization/view_memory.hpp"
#include "oort/matching/rejection.hpp"
#include "oort/odometry/odometry_model.hpp"
#include "oort/sensor/laser_rig.hpp"

namespace oort {

/// How far a localiser's pose can be relied on.
enum class LocalizationState {
  kSearching,  ///< no pose yet
  kTracking,   ///< scans fit the map at the pose
  kUncertain,  ///< they do not for a while, or not yet for long enough after a search, or the pose is known badly
  kLost,       ///< as before, for so long that the pose should not be used
};

std::string_view to_string(LocalizationState state);

struct LocalizationStatistics {
  std::uint64_t scans = 0;
  std::uint64_t matched = 0;   ///< scans whose match was accepted
  std::uint64_t searches = 0;  ///< of the whole map
  std::uint64_t jumps = 0;     ///< times that a search took the place of a pose which was no longer trusted
  RejectionCounts match_rejections;
  RejectionCounts search_rejections;
};

/// Follows a robot on a map that does not change. Matches are made near the pose that odometry expects; what the map
/// does not support is left to odometry, whose uncertainty adds up. While it is not tracking it searches the whole map.
/// Deterministic; not thread-safe.
class Localizer {
 public:
  /// Starts searching. Throws InputError if the pose is not finite.
  Localizer(std::shared_ptr<const ReferenceMap> map, const Parameters& parameters, const Pose2& T_base_sensor);

  /// Says about where the sensor is at the next scan, with its covariance along the axes of the map.
  /// Throws InputError if the pose is not finite or more than 100 km off, or the covariance is not positive definite.
  void start_at(const Pose2& T_map_sensor, const Eigen::Matrix3d& covariance);
  /// Forgets the pose.
  void start_searching();

  /// Takes the next scan, as Mapper::add_scan does. Throws InputError if the scan's limits, the pose or the motion are
  /// not finite, or the pose is more than 100 km off; nothing changes then.
  LocalizationState add_scan(const LaserScan& scan, const Pose2& T_odom_base, const Sweep& sweep_of_base = {});

  /// Takes a scan of another laser, as Mapper::add_scan_of_other().
  void add_scan_of_other(const Pose2& T_base_sensor, const LaserScan& scan, const Pose2& T_odom_base,
                         const Sweep& sweep_of_base = {}) {
    lasers_.remember(T_base_sensor, scan, T_odom_base, sweep_of_base);
  }

  LocalizationState state() const { return state_; }
  /// The sensor's pose at the latest scan; none while searching.
  std::optional<Pose2> T_map_sensor() const;
  /// Where odometry's frame is; none while searching.
  std::optional<Pose2> T_map_odom() const;
  /// Of T_map_sensor (x, y, theta), along the axes of the map.
  const Eigen::Matrix3d& covariance() const { return covariance_; }
  /// How well the latest scan fitted, see Support::value().
  double support() const { return support_; }
  const LocalizationStatistics& statistics() const { return statistics_; }

 private:
  /// Another pose that a search found while the present one was in doubt.
  struct Rival {
    Pose2 T_map_odom;
    double way;
  };

  void forget_pose();
  void predict(const Pose2& T_odom_sensor);
  void follow(const PointCloud& cloud);
  std::optional<Hypothesis> match(const PointCloud& cloud, Rejection& rejection);
  bool may_jump(const Hypothesis& found, const PlacedScan& scan);
  bool is_expected(const Hypothesis& found) const;
  bool has_innovation(const Hypothesis& found) const;
  bool contradicts_memory(const Hypothesis& found) const;
  void search(const PlacedScan& scan);
  LocalizationState judge() const;
  double deviation() const;

  std::shared_ptr<const ReferenceMap> map_;
  TrackingParameters parameters_;
  RelocalizerParameters kept_parameters_;
  int min_points_;
  LaserRig lasers_;
  Pose2 T_base_sensor_;
  OdometryModel odometry_model_;
  frsm::Matcher matcher_;
  Relocalizer relocalizer_;
  ViewMemory views_;

  LocalizationState state_ = LocalizationState::kSearching;
  std::optional<Pose2> T_map_sensor_;
  std::optional<Pose2> T_odom_sensor_;  // at the latest scan
  bool is_seen_ = false;                // at least one scan fitted there
  bool was_relied_on_ = false;          // it was told to the localiser, or tracked since a search found it
  double probation_ = 0.0;  // [m] of travel on which scans must still fit before a search's answer is relied on
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Identity();
  double support_ = 0.0;
  double travel_ = 0.0;  // [m] in all
  std::optional<Rival> rival_;
  double doubtful_travel_ = 0.0;  // [m] since the last match that was accepted
  int doubtful_scans_ = 0;
  LocalizationStatistics statistics_;
};

}  // namespace oort
