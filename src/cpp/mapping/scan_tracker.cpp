// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapping/scan_tracker.hpp"

#include "oort/mapping/frsm_scan_tracker.hpp"
#include "oort/mapping/grid_scan_tracker.hpp"

namespace oort {

std::unique_ptr<ScanTracker> make_scan_tracker(const IncrementalGraphBuilderParameters& parameters) {
  if (parameters.scanmatcher == "cartographer_matcher") {
    return std::make_unique<GridScanTracker>(parameters.cartographer_matcher);
  }
  return std::make_unique<FrsmScanTracker>(parameters.frsm_matcher);
}

}  // namespace oort
