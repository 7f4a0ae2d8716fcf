// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <frsm/types.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "oort/geometry/pose2.hpp"
#include "oort/matching/rejection.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// A motion of the sensor with its covariance, along the axes of the frame before.
struct Motion {
  Pose2 T_before_after;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  bool only_if_poor = false;  ///< as an alternative: tried only where the match with the first motion is poor
};

/// What a matcher said before a finer one took over.
struct CoarseMatch {
  Pose2 T_local_sensor;
  double inlier_ratio = 0.0;
};

/// Where the scan matcher says the sensor is, in its own ("local") frame.
struct TrackedScan {
  Pose2 T_local_sensor;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the match alone, axes of the local frame
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();   ///< of the match and what was expected, same axes
  double inlier_ratio = 0.0;
  double extent = 0.0;      ///< root mean square distance of the returns from their middle [m]
  bool degenerate = false;  ///< the match leaves a direction open
  bool restarted = false;   ///< a fresh local map begins with this scan: the old one did not fit any more
  Rejection rejection = Rejection::kNotMatched;  ///< of the match by itself: no gates
  std::size_t hypothesis = 0;              ///< which motion it was found with: 0 is the first, k the k-th alternative
  std::optional<CoarseMatch> first_stage;  ///< of a matcher of two stages

  bool usable() const { return rejection == Rejection::kNone; }
};

/// Follows the sensor from scan to scan by matching each against a local map of recent ones.
class ScanTracker {
 public:
  virtual ~ScanTracker() = default;

  /// Starts a fresh local map; its first scan will be at this pose of the local frame.
  virtual void reset(const Pose2& T_local_sensor) = 0;

  /// Takes the next scan: its returns in the sensor frame and the sensor's motion by odometry since the last one taken
  /// (since reset(): the identity), with the covariance of that motion along the axes of the frame before.
  /// `alternatives`: what the motion may have been instead, where odometry is doubted; the one whose match has clearly
  /// more inliers counts.
  virtual TrackedScan track(const frsm::Points& points, double time, const Motion& T_previous_sensor,
                            const std::vector<Motion>& alternatives) = 0;

  /// Overrules the matcher: the scan just tracked is at this pose of the local frame, and joins no local map.
  virtual void set_pose(const Pose2& T_local_sensor) = 0;
};

/// The tracker that incremental_graph_builder.scanmatcher names.
std::unique_ptr<ScanTracker> make_scan_tracker(const Parameters& parameters);

}  // namespace oort
