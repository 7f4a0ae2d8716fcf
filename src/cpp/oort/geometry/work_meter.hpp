// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace oort {

/// Counts work while it is done. One unit is about a microsecond of one core of a laptop; it is counted from sizes,
/// never from a clock, so that the same work counts the same everywhere. Expensive work is charged before it is done.
class WorkMeter {
 public:
  /// What a laptop's core does.
  static constexpr double kUnitsPerSecond = 1e6;

  virtual ~WorkMeter() = default;
  virtual void charge(std::uint64_t units) = 0;
};

/// Counts work that has a limit. Whoever does it looks whether any is left before it begins with more.
class WorkBudget : public WorkMeter {
 public:
  explicit WorkBudget(double units) : units_(units) {}
  void charge(std::uint64_t units) override { units_ -= static_cast<double>(units); }
  bool is_spent() const { return units_ <= 0.0; }

 private:
  double units_;  // left
};

/// Charges `units` if there is somebody who counts.
inline void charge(WorkMeter* meter, double units) {
  if (meter != nullptr) meter->charge(static_cast<std::uint64_t>(units) + 1);
}

}  // namespace oort
