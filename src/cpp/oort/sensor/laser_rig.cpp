// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/sensor/laser_rig.hpp"

#include <algorithm>
#include <cmath>

#include "oort/sensor/tuning.hpp"

namespace oort {
namespace {

bool is_same(const Pose2& a, const Pose2& b) {
  return a.x == b.x && a.y == b.y && a.theta == b.theta;
}

Point2 moved(const Point2& point, const Pose2& T_to_from) {
  if (!std::isfinite(point.x)) return {point.x, point.y + T_to_from.theta, point.z};  // no reading: y is the bearing
  const Eigen::Vector2d p = T_to_from * Eigen::Vector2d(point.x, point.y);
  return {round_to_float32(p.x()), round_to_float32(p.y()), point.z};
}

}  // namespace

LaserRig::LaserRig(const Parameters& parameters, const Pose2& T_base_main) : parameters_(parameters) {
  lasers_.push_back({Laser(parameters_, T_base_main)});
}

void LaserRig::remember(const Pose2& T_base_sensor, const LaserScan& scan, const Pose2& T_odom_base,
                        const Sweep& sweep_of_base) {
  std::size_t k = 1;
  while (k < lasers_.size() && !is_same(lasers_[k].laser.T_base_sensor(), T_base_sensor)) ++k;
  if (k == lasers_.size()) lasers_.push_back({Laser(parameters_, T_base_sensor)});
  lasers_[k].seen = lasers_[k].laser.take(scan, T_odom_base, sweep_of_base);
  lasers_[k].T_odom_sensor = T_odom_base * T_base_sensor;
}

PointCloud LaserRig::take(const LaserScan& scan, const Pose2& T_odom_base, const Sweep& sweep_of_base) {
  PointCloud cloud = lasers_.front().laser.take(scan, T_odom_base, sweep_of_base);
  std::size_t joined = 0;
  const Pose2 T_odom_main = T_odom_base * T_base_main();
  for (std::size_t k = 1; k < lasers_.size(); ++k) {
    const Mounted& other = lasers_[k];
    if (!(std::abs(cloud.time - other.seen.time) <= SensorTuning::kJoinedAge)) continue;
    const Pose2 T_main_other = between(T_odom_main, other.T_odom_sensor);
    ++joined;
    for (const Point2& point : other.seen.points) cloud.points.push_back(moved(point, T_main_other));
  }
  view_grew_ = joined > most_joined_;
  most_joined_ = std::max(most_joined_, joined);
  return cloud;
}

void LaserRig::forget() {
  const Pose2 T_base_main = main().T_base_sensor();
  lasers_.clear();
  most_joined_ = 0;
  view_grew_ = false;
  lasers_.push_back({Laser(parameters_, T_base_main)});
}

std::vector<LaserFindings> LaserRig::findings() const {
  std::vector<LaserFindings> findings;
  for (const Mounted& mounted : lasers_) findings.push_back(mounted.laser.findings());
  return findings;
}

}  // namespace oort
