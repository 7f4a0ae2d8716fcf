// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "oort/map/renumbering.hpp"

namespace oort {

/// How well the sensor's place on the map is known after a scan (docs/tracking.md).
enum class TrackingState {
  kTracking,   ///< the scan was placed by what it shows
  kUncertain,  ///< odometry alone says where it is, or its segment is untied
  kLost,       ///< it has been odometry alone for long, or neither odometry nor the scans can be trusted
};

/// As reports, messages and Python have it.
std::string_view to_string(TrackingState state);

/// Follows the tracking state from scan to scan. It counts scans and reads no clock.
class TrackingMonitor {
 public:
  /// Nodes from this one on are untied: what led from one to the other is not known. `is_guess`: and
  /// where they were put is little more than a guess. If older ones are still untied, all from those on are.
  void add_untied(std::uint64_t first_node, bool is_guess);

  bool is_untied() const { return is_untied_; }

  /// Looks whether closures that are on tie the newest node to the map, in one step or several. `part_begin`: the first
  /// node of the part of the map that they hold together with it.
  void look_for_tie(std::uint64_t part_begin) { is_untied_ = is_untied_ && part_begin >= untied_begin_; }

  /// Whether the newest nodes are where the map has them, as far as can be told: not if what they see contradicts it;
  /// if nothing speaks against it, untied ones are as well.
  void trust(bool trusted);

  /// The map's older nodes were reduced. Whether the newest ones contradict it is to be seen anew.
  void renumber(const Renumbering& nodes) {
    untied_begin_ = nodes.of(untied_begin_);
    is_contradicted_ = false;
  }

  /// Takes the next scan. `missed`: the scan matcher was asked and could not place it.
  TrackingState update(bool missed);

 private:
  bool is_untied_ = false;
  bool is_contradicted_ = false;
  bool is_guess_ = false;
  std::uint64_t untied_begin_ = 0;
  int missed_in_a_row_ = 0;
};

}  // namespace oort
