// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <frsm/tracker.hpp>

#include "oort/local_slam/scan_tracker.hpp"

namespace oort {

/// FRSM's tracker (incremental_graph_builder.frsm_matcher).
class FrsmScanTracker : public ScanTracker {
 public:
  /// `use_odometry`: whether motions are odometry's; else they are guesses, and the search is as wide as those need.
  FrsmScanTracker(const FrsmMatcherParameters& parameters, bool use_odometry);

  void reset(const Pose2& T_local_sensor) override;
  TrackedScan track(const frsm::Points& points, double time, const Motion& motion,
                    const std::vector<Motion>& alternatives) override;
  void set_pose(const Pose2& T_local_sensor) override;

 private:
  frsm::Tracker tracker_;
  Eigen::Matrix3d error_;  // of a match, beyond its own covariance
};

}  // namespace oort
