// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/geometry/sweep.hpp"
#include "oort/parameters/parameters.hpp"
#include "oort/sensor/beam_order.hpp"
#include "oort/sensor/body_sectors.hpp"
#include "oort/sensor/repeated_readings.hpp"

namespace oort {

/// What the scans of a laser have shown of it.
struct LaserFindings {
  BeamOrder beam_order = BeamOrder::kStamped;
  bool beam_order_is_decided = false;
  BeamOrderTest::Evidence beam_order_evidence;
  std::vector<BodySector> body;
  std::uint64_t repeated_scans = 0;  ///< that were the scan before once more
};

/// A laser on the robot: makes clouds of its scans, with what has been learned of the laser from them.
class Laser {
 public:
  Laser(const Parameters& parameters, const Pose2& T_base_sensor);

  const Pose2& T_base_sensor() const { return T_base_sensor_; }

  /// The scan in the sensor frame at its stamp: deskewed, and without the robot's own body; without a point if its
  /// readings are those of the scan before, though the base has moved. Throws InputError if the
  /// scan's limits or the sweep are not finite; nothing changes then.
  PointCloud take(const LaserScan& scan, const Pose2& T_odom_base, const Sweep& sweep_of_base);

  /// Takes the readings of the robot's body out of a cloud of before it was known. Whether there were any.
  bool remove_body_from(PointCloud& cloud) const;
  bool knows_body() const { return body_.found(); }

  LaserFindings findings() const;

 private:
  Pose2 T_base_sensor_;
  bool deskews_;
  bool tests_order_;
  BeamOrder given_order_;
  bool finds_body_;
  BeamOrderTest order_;
  BodyDetector body_;
  RepeatedReadings repeated_;
};

}  // namespace oort
