// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "frsm/contours.hpp"
#include "frsm/table.hpp"

namespace frsm {

/// The last scans, drawn. Two tables overlap by half: every scan is drawn into both, the older is the one to match
/// against, and when it holds `max_scans` it is dropped for the younger, which then holds half as many. So nothing is
/// ever redrawn or removed, and the map to match against holds between max_scans / 2 and max_scans scans (fewer at the
/// start). Sparse scans count half: of those that are far apart more are kept.
class History {
 public:
  /// max_scans >= 2.
  History(const TableParams& params, int max_scans);

  /// Draws a scan given in the table's frame, seen from `origin`; `is_sparse`: far from the scan before.
  void add(const Points& world, const std::vector<Contour>& contours, const Pose& origin, bool is_sparse = false);
  void clear();

  const Table& table() const { return older_.table; }
  int num_scans() const { return older_.scans; }
  std::size_t bytes() const { return older_.table.bytes() + younger_.table.bytes(); }

 private:
  struct Layer {
    Table table;
    int scans = 0;
    int halves = 0;  // 2 for each scan, 1 for a sparse one
  };
  static void clear(Layer& layer);

  Layer older_;
  Layer younger_;
  int max_scans_;
};

}  // namespace frsm
