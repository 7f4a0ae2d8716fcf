// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "frsm/history.hpp"

#include <utility>

#include "check.hpp"

namespace frsm {

History::History(const TableParams& params, int max_scans)
    : older_{Table(params)}, younger_{Table(params)}, max_scans_(max_scans) {
  check(max_scans >= 2, "History.max_scans", "must be at least 2");
}

void History::add(const Points& world, const std::vector<Contour>& contours, const Pose& origin, bool is_sparse) {
  const auto draw = [&](Layer& layer) {
    layer.table.draw(world, contours, origin);
    ++layer.scans;
    layer.halves += is_sparse ? 1 : 2;
  };
  draw(older_);
  if (older_.halves > max_scans_) draw(younger_);  // the younger begins when the older is half full
  if (older_.halves >= 2 * max_scans_) {
    std::swap(older_, younger_);
    clear(younger_);
  }
}

void History::clear() {
  clear(older_);
  clear(younger_);
}

void History::clear(Layer& layer) {
  layer.table.clear();
  layer.scans = layer.halves = 0;
}

}  // namespace frsm
