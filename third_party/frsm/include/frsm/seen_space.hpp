// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <deque>

#include "frsm/types.hpp"
#include "frsm/view.hpp"

namespace frsm {

/// What the scans of a local map saw: elsewhere it shows nothing, and a point there speaks neither for a pose nor
/// against it.
class SeenSpace {
 public:
  /// Adds a scan, its points in sensor order, seen from `origin`; the latest `most` scans are kept.
  void add(const Points& body, const Pose& origin, std::size_t most);
  void clear();

  /// Whether one of the scans could have seen what is there.
  bool covers(const Point& world) const;
  /// The points that lie, with the sensor at a pose, where one of the scans could have seen them; in their order.
  Points covered(const Points& body, const Pose& pose) const;

  /// The points but for those beside the edge of what the latest scan saw, to the side to which the sensor has turned
  /// since [rad]. All of them if that scan saw far around, or fewer than `least` would be left.
  Points without_new_edge(const Points& body, double turn, std::size_t least) const;

 private:
  struct Sector {
    double middle = 0.0;  // the mean bearing [rad]
    double right = 0.0;   // its edges, seen from there [rad]
    double left = 0.0;
  };
  static Sector sector_of(const Points& body);

  std::deque<View> views_;
  Sector latest_;
};

}  // namespace frsm
