// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "oort/localization/reference_map.hpp"
#include "oort/localization/relocalizer.hpp"

namespace oort {

/// The latest scans of a drive that each show something else than the one before.
class ViewMemory {
 public:
  /// A scan is a new view once the sensor moved by `distance` [m] or turned by `angle` [rad] since the last one. The
  /// latest `capacity` views are kept.
  ViewMemory(double distance, double angle, std::size_t capacity);

  /// Whether the scan is a new view, which is then kept.
  bool add(const PlacedScan& scan);
  void clear() { views_.clear(); }

  /// The newest views, at most `count`, oldest first.
  std::vector<PlacedScan> latest(std::size_t count) const;

  /// How well all views fit the map if that is where odometry's frame lies.
  Support weigh(const ReferenceMap& map, const Pose2& T_map_odom) const;

 private:
  double distance_, angle_;
  std::size_t capacity_;
  std::vector<PlacedScan> views_;  // oldest first
};

}  // namespace oort
