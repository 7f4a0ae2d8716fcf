// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/work_clock.hpp"

#include <ctime>

namespace oort {
namespace {

double thread_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

WorkClock::WorkClock(double& seconds) : seconds_(seconds), started_(thread_seconds()) {}

WorkClock::~WorkClock() {
  seconds_ += thread_seconds() - started_;
}

}  // namespace oort
