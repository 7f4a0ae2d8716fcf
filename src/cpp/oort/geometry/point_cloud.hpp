// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace oort {

/// One planar laser scan as a sensor delivers it (the fields of sensor_msgs/LaserScan). The number of beams may differ
/// from scan to scan.
struct LaserScan {
  double time = 0.0;             ///< stamp [s]; a label, never a sort key
  double angle_min = 0.0;        ///< bearing of ranges[0] [rad]
  double angle_increment = 0.0;  ///< [rad], negative for a clockwise sensor
  double range_min = 0.0;        ///< [m]
  double range_max = 0.0;        ///< [m]; a reading at or beyond it has no return
  std::vector<float> ranges;     ///< [m]; may hold nan and inf
};

/// One beam's end in the sensor frame, with the semantics of the map file's Point2d:
/// - a return: x, y [m], z = 1;
/// - a finite range below range_min, or at or beyond range_max: x, y kept, z = nan;
/// - a nan or infinite range: x = that range, y = the beam's bearing [rad], z = nan.
/// Coordinates are rounded to float32, as the map file's are.
struct Point2 {
  double x = 0.0;
  double y = 0.0;
  double z = 1.0;

  bool is_return() const { return z == 1.0; }
};

/// What a scan saw, in beam order.
struct PointCloud {
  std::uint64_t id = 0;  ///< the node it was captured at
  double time = 0.0;     ///< [s]
  std::vector<Point2> points;
};

/// Converts a scan; one point per beam, in beam order, in the sensor frame. `id` is left 0.
/// Throws InputError if the scan's angles or limits are not finite.
PointCloud to_point_cloud(const LaserScan& scan);

/// The nearest number that fits into a float32, as the map file stores coordinates.
double round_to_float32(double value);

/// The number of returns in a cloud.
std::size_t count_returns(const PointCloud& cloud);

}  // namespace oort
