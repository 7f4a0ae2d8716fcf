// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "frsm/types.hpp"

namespace frsm {

/// What a scan saw: by bearing, how far it saw. Where it had no return nothing is known.
class View {
 public:
  /// `body`: the points of the scan in sensor order, seen from `origin`.
  View(const Points& body, const Pose& origin);

  /// Whether the scan would have seen a surface there, or something before it: a point beyond is none that it tells of.
  bool covers(const Point& world) const;

 private:
  Pose origin_;
  std::vector<float> ranges_;  // by bearing [m]; 0: not seen
};

}  // namespace frsm
