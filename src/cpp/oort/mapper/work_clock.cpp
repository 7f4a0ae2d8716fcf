// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/work_clock.hpp"

#include <ctime>

namespace oort {
namespace {

double seconds_of(clockid_t clock) {
  std::timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

WorkClock::WorkClock(double& seconds) : seconds_(seconds), started_(seconds_of(CLOCK_THREAD_CPUTIME_ID)) {}

WorkClock::~WorkClock() {
  seconds_ += seconds_of(CLOCK_THREAD_CPUTIME_ID) - started_;
}

WallClock::WallClock(double& seconds) : seconds_(seconds), started_(seconds_of(CLOCK_MONOTONIC)) {}

WallClock::~WallClock() {
  seconds_ += seconds_of(CLOCK_MONOTONIC) - started_;
}

}  // namespace oort
