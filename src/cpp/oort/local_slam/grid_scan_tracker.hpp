// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "oort/local_slam/local_grids.hpp"
#include "oort/local_slam/scan_tracker.hpp"
#include "oort/matching/scan_matcher.hpp"

namespace oort {

/// As Cartographer does (incremental_graph_builder.cartographer_matcher): a real-time correlative search on a coarse
/// grid of the latest scans, refined by Ceres on a finer one, and if wanted once more on a still finer one. Odometry
/// says where to look; how far it may be off is in the matchers' windows and weights, not in its covariance.
class GridScanTracker : public ScanTracker {
 public:
  explicit GridScanTracker(const CartographerMatcherParameters& parameters);

  void reset(const Pose2& T_local_sensor) override;
  /// `time` and `covariance` have no effect.
  TrackedScan track(const frsm::Points& points, double time, const Motion& motion,
                    const std::vector<Motion>& alternatives) override;
  void set_pose(const Pose2& T_local_sensor) override;

  const LocalGrids& local_map() const { return grids_; }

 private:
  struct Pending {
    Points points;
    Pose2 T_local_sensor;
  };

  Points in_range(const frsm::Points& points) const;
  void join_pending();
  bool is_key_scan(const Pose2& T_local_sensor) const;
  TrackedScan match(const Points& points, const Pose2& expected) const;
  TrackedScan begin(const Points& points, const Pose2& T_local_sensor);

  CartographerMatcherParameters parameters_;
  LocalGrids grids_;
  Pose2 pose_;
  Pose2 last_joined_;
  std::optional<Pending> pending_;  // joins the local map at the next track() unless overruled
  int rejected_ = 0;                // unusable scans in a row
};

}  // namespace oort
