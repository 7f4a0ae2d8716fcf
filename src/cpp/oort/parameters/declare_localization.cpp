// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// The keys of localisation on a saved map: none is documented of the original, which had a particle filter beside it.
#include "oort/parameters/internal/declare.hpp"

namespace oort {
namespace {

void declare_relocalizer(const Section& v, RelocalizerParameters& p) {
  v(p.max_scans, "max_scans", {5, "scans", {1, 50}}, "Latest scans that are looked for together.").own(5);
  v(p.scan_distance, "scan_distance", {0.2, "m", {0.0, 10.0}},
    "A scan is kept for the search once the sensor moved this far since the one before.")
      .own(0.2);
  v(p.scan_angle, "scan_angle", {0.4, "rad", {0.0, 3.15}}, "Or once it turned this far.").own(0.4);
  v(p.min_points, "min_points", {60, "points", {1, 100000}},
    "Fewer places of 5 cm that the scans hit are not looked for.")
      .own(60);
  v(p.min_support, "min_support", {0.85, "fraction", {0.0, 1.0}},
    "Least support of an answer: the share of returns that lie on surfaces of the map that face the sensor, less the "
    "share that went through known walls.")
      .own(0.85);
  v(p.min_lead, "min_lead", {0.12, "fraction", {0.0, 1.0}},
    "By how much more support an answer must have than any other place; else it is rejected as ambiguous.")
      .own(0.12);
  v(p.max_position_deviation, "max_position_deviation", {0.05, "m", {0.001, 10.0}},
    "Answers whose match leaves a direction more uncertain (standard deviation) are rejected as imprecise.")
      .own(0.05);
  v(p.max_heading_deviation, "max_heading_deviation", {0.04, "rad", {0.001, 3.15}}, "Likewise of the heading.")
      .own(0.04);
}

void declare_tracking(const Section& v, TrackingParameters& p) {
  v(p.search_window_xy, "search_window_xy", {0.4, "m", {0.02, 10.0}},
    "Widest half width of the search about the pose that odometry expects; it is three standard deviations.")
      .own(0.4);
  v(p.search_window_theta, "search_window_theta", {0.3, "rad", {0.01, 3.15}}, "Likewise in heading.").own(0.3);
  v(p.min_support, "min_support", {0.6, "fraction", {0.0, 1.0}},
    "Matches of less support are left to odometry; see relocalizer.min_support.")
      .own(0.6);
  v(p.uncertain_deviation, "uncertain_deviation", {0.2, "m", {0.001, 10.0}},
    "Standard deviation of the position above which the localiser says that it is uncertain.")
      .own(0.2);
  v(p.lost_deviation, "lost_deviation", {0.6, "m", {0.001, 100.0}}, "And above which it says that it is lost.")
      .own(0.6);
  v(p.doubt_distance, "doubt_distance", {1.0, "m", {0.01, 100.0}},
    "After so much travel with rejected matches only it is uncertain; after three times as much, lost. And so much "
    "travel "
    "must fit the map after a search of all of it before its answer is relied on.")
      .own(1.0);
}

}  // namespace

void declare_localization(const Section& v, LocalizationParameters& p) {
  declare_relocalizer(v.section("relocalizer"), p.relocalizer);
  declare_tracking(v.section("tracking"), p.tracking);
}

}  // namespace oort
