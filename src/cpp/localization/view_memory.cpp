// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/localization/view_memory.hpp"

#include <algorithm>
#include <cmath>

namespace oort {

ViewMemory::ViewMemory(double distance, double angle, std::size_t capacity)
    : distance_(distance), angle_(angle), capacity_(capacity) {}

bool ViewMemory::add(const PlacedScan& scan, const std::optional<Pose2>& T_map_odom) {
  if (!views_.empty()) {
    const Pose2 moved = between(views_.back().scan.T_odom_sensor, scan.T_odom_sensor);
    if (moved.translation().norm() < distance_ && std::abs(moved.theta) < angle_) return false;
  }
  if (views_.size() >= capacity_) views_.erase(views_.begin());
  views_.push_back({scan, T_map_odom});
  return true;
}

void ViewMemory::forget_beliefs() {
  for (View& view : views_) view.T_map_odom.reset();
}

std::vector<PlacedScan> ViewMemory::latest(std::size_t count) const {
  std::vector<PlacedScan> scans;
  for (std::size_t k = views_.size() - std::min(count, views_.size()); k < views_.size(); ++k) {
    scans.push_back(views_[k].scan);
  }
  return scans;
}

std::optional<Pose2> ViewMemory::T_map_odom_before(std::size_t count) const {
  for (std::size_t k = views_.size() - std::min(count, views_.size()); k < views_.size(); ++k) {
    if (views_[k].T_map_odom) return views_[k].T_map_odom;
  }
  return std::nullopt;
}

Support ViewMemory::weigh(const ReferenceMap& map, const Pose2& T_map_odom) const {
  Support support;
  for (const View& view : views_) map.weigh(view.scan.cloud, T_map_odom * view.scan.T_odom_sensor, support);
  return support;
}

}  // namespace oort
