// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"

namespace oort {

/// Bearings of a sensor at which it sees the robot it sits on.
struct BodySector {
  double from = 0.0;   ///< [rad], counter-clockwise
  double to = 0.0;     ///< to this [rad]
  double range = 0.0;  ///< the farthest reading of the body there [m]
};

/// Finds the beams that see the robot itself: at the same bearing the same short range, over metres and turns of
/// driving. No wall keeps its range while the robot turns. Until that is known, a bearing that has shown nothing else
/// since the beginning, though the robot moved, is suspected. Deterministic; a scan costs a step per beam.
class BodyDetector {
 public:
  BodyDetector();

  /// Takes a scan; the pose by odometry is the base's. Returns whether the sectors grew.
  bool add(const LaserScan& scan, const Pose2& T_odom_base);

  /// Makes the readings of the body, and suspected ones, ones that say nothing (x = nan). The cloud is in the sensor
  /// frame, in beam order.
  void remove_from(PointCloud& cloud) const;

  bool found() const { return found_; }
  std::vector<BodySector> sectors() const;

 private:
  struct Bin {
    float range = 0.0F;      // that it has shown since; 0: none
    std::uint32_t hits = 0;  // scans that showed it
    std::uint32_t misses = 0;
    double travel = 0.0;  // at its begin [m]
    double turn = 0.0;    // [rad]
    bool is_body = false;
    bool has_changed = false;  // whether it has ever shown something else
  };

  bool is_ripe(const Bin& bin, double factor) const;
  bool is_suspect(const Bin& bin) const;
  bool convict();
  bool is_of_body(const Point2& point) const;

  std::vector<Bin> bins_;
  bool found_ = false;
  bool begun_ = false;
  Pose2 T_odom_base_;
  double travel_ = 0.0;  // of the base, in all [m]
  double turn_ = 0.0;    // [rad]
};

}  // namespace oort
