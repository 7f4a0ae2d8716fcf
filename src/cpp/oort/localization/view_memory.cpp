// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/localization/view_memory.hpp"

#include <algorithm>
#include <cmath>

namespace oort {

ViewMemory::ViewMemory(double distance, double angle, std::size_t capacity)
    : distance_(distance), angle_(angle), capacity_(capacity) {}

bool ViewMemory::add(const PlacedScan& scan) {
  if (!views_.empty()) {
    const Pose2 moved = between(views_.back().T_odom_sensor, scan.T_odom_sensor);
    if (moved.translation().norm() < distance_ && std::abs(moved.theta) < angle_) return false;
  }
  if (views_.size() >= capacity_) views_.erase(views_.begin());
  views_.push_back(scan);
  return true;
}

std::vector<PlacedScan> ViewMemory::latest(std::size_t count) const {
  return {views_.end() - static_cast<std::ptrdiff_t>(std::min(count, views_.size())), views_.end()};
}

Support ViewMemory::weigh(const ReferenceMap& map, const Pose2& T_map_odom) const {
  Support support;
  for (const PlacedScan& view : views_) map.weigh(view.cloud, T_map_odom * view.T_odom_sensor, support);
  return support;
}

}  // namespace oort
