// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "oort/localization/reference_map.hpp"
#include "oort/localization/relocalizer.hpp"

namespace oort {

/// The latest scans of a drive that each show something else than the one before, and where odometry's frame was
/// believed to be on the map at each.
class ViewMemory {
 public:
  /// A scan is a new view once the sensor moved by `distance` [m] or turned by `angle` [rad] since the last one. The
  /// latest `capacity` views are kept.
  ViewMemory(double distance, double angle, std::size_t capacity);

  /// Whether the scan is a new view, which is then kept.
  bool add(const PlacedScan& scan, const std::optional<Pose2>& T_map_odom);
  void clear() { views_.clear(); }
  /// What was believed is no longer.
  void forget_beliefs();

  /// The newest views, at most `count`, oldest first.
  std::vector<PlacedScan> latest(std::size_t count) const;

  /// What was believed so many views ago, or as many of them as are kept; none if nothing was.
  std::optional<Pose2> T_map_odom_before(std::size_t count) const;

  /// How well all views fit the map if that is where odometry's frame lies.
  Support weigh(const ReferenceMap& map, const Pose2& T_map_odom) const;

 private:
  struct View {
    PlacedScan scan;
    std::optional<Pose2> T_map_odom;
  };

  double distance_, angle_;
  std::size_t capacity_;
  std::vector<View> views_;  // oldest first
};

}  // namespace oort
