// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/sensor/laser.hpp"

#include <utility>

namespace oort {

Laser::Laser(const Parameters& parameters, const Pose2& T_base_sensor)
    : T_base_sensor_(T_base_sensor),
      deskews_(parameters.motion_compensation),
      tests_order_(parameters.beam_order == "auto"),
      given_order_(parameters.beam_order == "reversed" ? BeamOrder::kReversed : BeamOrder::kStamped),
      finds_body_(parameters.find_body) {}

PointCloud Laser::take(const LaserScan& scan, const Pose2& T_odom_base, const Sweep& sweep_of_base) {
  PointCloud cloud = to_point_cloud(scan);
  const Sweep sweep = deskews_ ? sweep_of_sensor(sweep_of_base, T_base_sensor_) : Sweep{};
  PointCloud deskewed = deskew(cloud, in_order(sweep, tests_order_ ? order_.order() : given_order_));
  // From here on nothing throws.
  if (repeated_.add(scan.ranges, count_returns(deskewed), T_odom_base)) {
    deskewed.points.clear();
    return deskewed;
  }
  if (finds_body_) {
    body_.add(scan, T_odom_base);
    body_.remove_from(deskewed);
  }
  if (tests_order_ && deskews_ && !order_.is_decided()) {
    body_.remove_from(cloud);
    order_.add(cloud, T_odom_base * T_base_sensor_, sweep);
  }
  return deskewed;
}

bool Laser::remove_body_from(PointCloud& cloud) const {
  const std::size_t before = count_returns(cloud);
  if (finds_body_) body_.remove_from(cloud);
  return count_returns(cloud) < before;
}

LaserFindings Laser::findings() const {
  return {tests_order_ ? order_.order() : given_order_, order_.is_decided(), order_.evidence(), body_.sectors(),
          repeated_.count()};
}

}  // namespace oort
