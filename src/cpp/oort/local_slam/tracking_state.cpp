// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/local_slam/tracking_state.hpp"

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
  is_contradicted_ = false;  // of nodes before
}

void TrackingMonitor::trust(bool trusted) {
  is_contradicted_ = !trusted;
  if (trusted) is_untied_ = false;
}

TrackingState TrackingMonitor::update(bool missed) {
  missed_in_a_row_ = missed ? missed_in_a_row_ + 1 : 0;
  if (missed_in_a_row_ >= LocalSlamTuning::kLostScans || (is_untied_ && is_guess_)) return TrackingState::kLost;
  return is_untied_ || is_contradicted_ || missed ? TrackingState::kUncertain : TrackingState::kTracking;
}

}  // namespace oort
