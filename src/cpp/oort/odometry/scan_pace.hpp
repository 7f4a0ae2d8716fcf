// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>

namespace oort {

/// The time between scans. Stamps are often those of arrival: scans that come in bursts were not taken in one.
class ScanPace {
 public:
  /// The interval before the next scan [s], from that of its stamps: what is much shorter than usual is taken for the
  /// usual.
  double next(double interval);

  /// Whether intervals enough came to know the usual one.
  bool is_known() const;
  void forget() { intervals_.clear(); }

 private:
  std::deque<double> intervals_;  // the latest [s]
};

}  // namespace oort
