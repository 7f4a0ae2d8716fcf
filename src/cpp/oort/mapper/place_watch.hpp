// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "oort/geometry/work_meter.hpp"
#include "oort/map/map.hpp"

namespace oort {

/// Notices a robot that is not where the map has it although each scan fitted the one before: one that was carried
/// between two places that look alike, or that a false closure holds at the wrong place. What newer nodes see goes
/// through what older ones near by saw there, or the other way round (docs/tracking.md).
class PlaceWatch {
 public:
  /// Compares a node, newer than those before, with the older ones around it.
  void look(const Map& map, std::uint64_t node, WorkMeter* meter);

  /// The first of the latest nodes that contradict older ones, if most of the latest do.
  std::optional<std::uint64_t> first_suspect() const;

  void forget() { seen_.clear(); }

 private:
  struct Seen {
    std::uint64_t node;
    double contradicting;  // share of what could be compared
  };

  std::deque<Seen> seen_;  // the latest nodes that could be compared, the oldest first
};

}  // namespace oort
