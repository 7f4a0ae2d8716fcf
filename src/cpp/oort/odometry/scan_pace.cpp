// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/odometry/scan_pace.hpp"

#include <numeric>

#include "oort/odometry/tuning.hpp"

namespace oort {

double ScanPace::next(double interval) {
  if (interval > 0.0) intervals_.push_back(interval);
  if (intervals_.size() > OdometryTuning::kUsualIntervals) intervals_.pop_front();
  if (intervals_.empty()) return interval;
  const double usual =
      std::accumulate(intervals_.begin(), intervals_.end(), 0.0) / static_cast<double>(intervals_.size());
  return interval < OdometryTuning::kBurst * usual ? usual : interval;
}

bool ScanPace::is_known() const {
  return intervals_.size() >= OdometryTuning::kMinIntervals;
}

}  // namespace oort
