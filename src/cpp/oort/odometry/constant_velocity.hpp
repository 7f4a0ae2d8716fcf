// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "oort/geometry/pose2.hpp"
#include "oort/odometry/scan_pace.hpp"

namespace oort {

/// Stands in for odometry where there is none: the base goes on as it moved between the last two scans, and may
/// accelerate. Judges by stamps and poses alone; deterministic.
class ConstantVelocity {
 public:
  struct Prediction {
    Pose2 T_before_after;
    Eigen::Matrix3d covariance;  ///< along the axes of the frame before
  };

  /// The motion from the last scan to the one at a time [s], which counts as the last one from now on.
  Prediction predict(double time);

  /// Says how the base moved since the scan before the last one. Where no match says so it is thought to come to rest:
  /// a prediction that feeds on itself would run away.
  void moved(const Pose2& T_before_after, bool is_matched);

  /// The next scan is the first one.
  void forget();

 private:
  std::optional<double> last_time_;
  ScanPace pace_;
  double interval_ = 0.0;        // before the last scan [s]
  double moved_interval_ = 0.0;  // over which the base moved so [s]
  Pose2 motion_;
};

}  // namespace oort
