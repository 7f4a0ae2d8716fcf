// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "frsm/history.hpp"

#include <utility>

#include "check.hpp"

namespace frsm {

History::History(const TableParams& params, int max_scans)
    : older_{Table(params), 0}, younger_{Table(params), 0}, max_scans_(max_scans) {
  check(max_scans >= 2, "History.max_scans", "must be at least 2");
}

void History::add(const Points& world, const std::vector<Contour>& contours, const Pose& origin) {
  older_.table.draw(world, contours, origin);
  ++older_.scans;
  if (2 * older_.scans > max_scans_) {  // the younger begins when the older is half full
    younger_.table.draw(world, contours, origin);
    ++younger_.scans;
  }
  if (older_.scans >= max_scans_) {
    std::swap(older_, younger_);
    younger_.table.clear();
    younger_.scans = 0;
  }
}

void History::clear() {
  for (Layer* layer : {&older_, &younger_}) {
    layer->table.clear();
    layer->scans = 0;
  }
}

}  // namespace frsm
