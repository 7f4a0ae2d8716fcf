// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace oort {

/// What the time of mapping went into. For people only: nothing that is decided may depend on a clock.
struct WorkSeconds {
  double tracking = 0.0;    ///< CPU time of local SLAM [s]
  double candidates = 0.0;  ///< CPU time of looking for places that may have been seen before [s]
  double matching = 0.0;    ///< CPU time of drawing those places and matching with them [s]
  double solving = 0.0;     ///< CPU time of solving the graph [s]
  double waiting = 0.0;     ///< wall time that local SLAM waited for global SLAM [s]
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

/// The same of wall time.
class WallClock {
 public:
  explicit WallClock(double& seconds);
  ~WallClock();
  WallClock(const WallClock&) = delete;
  WallClock& operator=(const WallClock&) = delete;

 private:
  double& seconds_;
  double started_;
};

}  // namespace oort
