// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/local_slam/scan_tracker.hpp"

#include "oort/local_slam/frsm_scan_tracker.hpp"
#include "oort/local_slam/grid_scan_tracker.hpp"

namespace oort {

std::unique_ptr<ScanTracker> make_scan_tracker(const Parameters& all) {
  const IncrementalGraphBuilderParameters& parameters = all.incremental_graph_builder;
  if (parameters.scanmatcher == "cartographer_matcher") {
    return std::make_unique<GridScanTracker>(parameters.cartographer_matcher);
  }
  return std::make_unique<FrsmScanTracker>(parameters.frsm_matcher, all.use_odometry);
}

}  // namespace oort
