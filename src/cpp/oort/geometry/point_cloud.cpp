// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/geometry/point_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "oort/geometry/errors.hpp"
#include "oort/geometry/tuning.hpp"

namespace oort {
namespace {

void check_fields(const LaserScan& scan) {
  if (!std::isfinite(scan.angle_min) || !std::isfinite(scan.angle_increment) || std::isnan(scan.range_min) ||
      std::isnan(scan.range_max)) {
    throw InputError(
        "laser scan: angle_min, angle_increment, range_min and range_max must be numbers; check the driver that fills "
        "them in");
  }
  const auto beams = static_cast<double>(scan.ranges.size());
  if (beams > GeometryTuning::kMaxBeams) {
    throw InputError("laser scan: " + std::to_string(scan.ranges.size()) + " beams are more than any laser has");
  }
  const double step = std::abs(scan.angle_increment);
  const bool spreads = step >= GeometryTuning::kMinAngleIncrement && beams * step <= GeometryTuning::kMaxFieldOfView;
  if (std::abs(scan.angle_min) > GeometryTuning::kMaxFieldOfView || (beams > 1.0 && !spreads)) {
    throw InputError("laser scan: " + std::to_string(scan.ranges.size()) + " beams from angle_min " +
                     std::to_string(scan.angle_min) + " on by angle_increment " + std::to_string(scan.angle_increment) +
                     " overlap or go beyond two turns; check the driver that fills them in");
  }
}

}  // namespace

// Volatile, because GCC 12 drops a rounding to float32 and back where it vectorises the two coordinates (-O2 and up).
double round_to_float32(double value) {
  const volatile float rounded = static_cast<float>(value);
  return rounded;
}

PointCloud to_point_cloud(const LaserScan& scan) {
  check_fields(scan);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  PointCloud cloud;
  cloud.time = scan.time;
  cloud.points.reserve(scan.ranges.size());
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    const double bearing = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    if (range >= GeometryTuning::kMaxRange) {
      cloud.points.push_back({std::numeric_limits<double>::infinity(), bearing, kNan});
      continue;
    }
    if (range <= -GeometryTuning::kMaxRange ||
        std::isnan(range)) {  // -inf means "too close" (REP 117): as unknown as nan
      cloud.points.push_back({kNan, bearing, kNan});
      continue;
    }
    const bool is_return = range >= scan.range_min && range < scan.range_max;
    cloud.points.push_back({round_to_float32(range * std::cos(bearing)), round_to_float32(range * std::sin(bearing)),
                            is_return ? 1.0 : kNan});
  }
  return cloud;
}

std::size_t count_returns(const PointCloud& cloud) {
  return static_cast<std::size_t>(
      std::count_if(cloud.points.begin(), cloud.points.end(), [](const Point2& p) { return p.is_return(); }));
}

}  // namespace oort
