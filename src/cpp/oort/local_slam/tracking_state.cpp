// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/local_slam/tracking_state.hpp"

#include <algorithm>

#include "oort/local_slam/tuning.hpp"

namespace oort {

std::string_view to_string(TrackingState state) {
  switch (state) {
    case TrackingState::kTracking:
      return "tracking";
    case TrackingState::kUncertain:
      return "uncertain";
    case TrackingState::kLost:
      return "lost";
  }
  return "unknown";
}

void TrackingMonitor::add_untied(std::uint64_t first_node, bool is_guess) {
  if (!is_untied_) untied_begin_ = first_node;
  is_guess_ = is_guess || (is_untied_ && is_guess_);
  is_untied_ = true;
}

void TrackingMonitor::look_for_tie(const Graph& graph, std::uint64_t segment_begin) {
  if (!is_untied_) return;
  const auto ties = [&](const SwitchableEdge& edge) {
    return edge.is_on() && std::max(edge.i, edge.j) >= segment_begin && std::min(edge.i, edge.j) < untied_begin_;
  };
  is_untied_ = std::none_of(graph.switchable_edges.begin(), graph.switchable_edges.end(), ties);
}

TrackingState TrackingMonitor::update(bool missed) {
  missed_in_a_row_ = missed ? missed_in_a_row_ + 1 : 0;
  if (missed_in_a_row_ >= LocalSlamTuning::kLostScans || (is_untied_ && is_guess_)) return TrackingState::kLost;
  return is_untied_ || missed ? TrackingState::kUncertain : TrackingState::kTracking;
}

}  // namespace oort
