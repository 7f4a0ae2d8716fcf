// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace oort {

/// What the CPU time of mapping went into, in seconds of the thread that maps. For people only: nothing that is decided
/// may depend on a clock.
struct WorkSeconds {
  double tracking = 0.0;    ///< matching scans with the local map
  double candidates = 0.0;  ///< looking for places that may have been seen before
  double matching = 0.0;    ///< drawing those places and matching with them
  double solving = 0.0;     ///< the graph
};

/// Adds the CPU time of this thread, from here to the end of the scope, to a sum.
class WorkClock {
 public:
  explicit WorkClock(double& seconds);
  ~WorkClock();
  WorkClock(const WorkClock&) = delete;
  WorkClock& operator=(const WorkClock&) = delete;

 private:
  double& seconds_;
  double started_;
};

}  // namespace oort
