// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "oort/graph/graph.hpp"
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

  /// Looks whether a closure that is on ties the newest segment, which begins with the node `segment_begin`, to the
  /// map.
  void look_for_tie(const Graph& graph, std::uint64_t segment_begin);

  /// The map's older nodes were reduced.
  void renumber(const Renumbering& nodes) { untied_begin_ = nodes.of(untied_begin_); }

  /// Takes the next scan. `missed`: the scan matcher was asked and could not place it.
  TrackingState update(bool missed);

 private:
  bool is_untied_ = false;
  bool is_guess_ = false;
  std::uint64_t untied_begin_ = 0;
  int missed_in_a_row_ = 0;
};

}  // namespace oort
