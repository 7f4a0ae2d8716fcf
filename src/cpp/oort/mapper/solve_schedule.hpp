// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "oort/mapper/tuning.hpp"

namespace oort {

/// When a graph that closures are added to is solved, and how much of it.
///
/// A large innovation is solved for at once; in a large graph by moving the newest nodes alone, which costs the same
/// however large the map is. The rest waits until the graph has grown by a twentieth, so that the work of all solves
/// together stays in proportion to the graph.
class SolveSchedule {
 public:
  enum class Extent { kNothing, kNewest, kAll };

  /// `large`: from more nodes on, a large innovation moves the newest nodes alone.
  explicit SolveSchedule(std::uint64_t large = MapperTuning::kNewestNodes) : large_(large) {}

  /// A closure was added, this far from where the graph expected it (squared Mahalanobis distance).
  void add_closure(double innovation);

  /// What to solve now. `size`: of the graph, in nodes; `progress`: how far the work that brings closures has come
  /// (nodes while mapping, closures while merging).
  Extent due(std::uint64_t size, std::uint64_t progress) const;

  std::uint64_t pending() const { return pending_; }  ///< closures since the last solve
  void solved_newest();
  void solved_all(std::uint64_t progress);

 private:
  std::uint64_t large_;
  std::uint64_t pending_ = 0;
  bool large_innovation_ = false;
  std::uint64_t progress_at_last_ = 0;
};

}  // namespace oort
