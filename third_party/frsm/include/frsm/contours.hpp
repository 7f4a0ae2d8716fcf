// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

#include "frsm/types.hpp"

namespace frsm {

/// Limits on linking two range points into one line. All distances in metres.
struct ContourParams {
  double max_adjacent_distance = 5.0;       ///< links are shorter than this
  double always_okay_distance = 0.33;       ///< at or below this a link needs no look at its neighbours
  double always_accept_distance = 0.1;      ///< a partner as near as this ends the search for a better one
  double max_first_distance = 1.0;          ///< longest link between two points that have no other link
  double max_distance_ratio = 1.8;          ///< of a link's length to that of the link beside it
  double min_distance_for_ratio = 0.08;     ///< the ratio counts only beside links at least this long
  double max_distance_without_ratio = 0.4;  ///< longest link beside a shorter (or no) one
  double max_beam_step = 0.0;               ///< [rad] neighbours whose beams are nearer may be linked at any distance
  double widest_beam_step = 0.0;            ///< [rad] or than the scan's own step, if that is at most this
  double max_beam_slope = 1.0;              ///< if their ranges differ by at most this share of their beams' distance
  double max_straight_slope = 6.0;          ///< the same where they go on straight: a wall at a grazing angle
  int search_range = 4;                     ///< how many indices away a partner may be

  /// Long-range sensor with fine steps on a slow robot (Hokuyo UTM-like).
  static ContourParams utm();
  /// Short-range, coarse sensor (Hokuyo URG-like, depth cameras).
  static ContourParams urg();
  /// Long-range sensor of 0.5 to 1 degree steps (SICK LMS-like). The default.
  static ContourParams sick();

  /// Throws std::invalid_argument that names the field when a value makes no sense.
  void validate() const;
};

/// Indices of the points of one line, increasing. One index alone is an isolated point.
using Contour = std::vector<std::size_t>;

/// Links points to lines, shortest links first. Each point is in exactly one contour; contours are ordered by their
/// first point. O(n R + n log n). Points must be finite.
std::vector<Contour> extract_contours(const Points& points, const ContourParams& params);

}  // namespace frsm
