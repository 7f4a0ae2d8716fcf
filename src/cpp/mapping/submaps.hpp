// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <frsm/contours.hpp>
#include <frsm/table.hpp>
#include <limits>
#include <list>
#include <memory>
#include <vector>

#include "oort/mapping/chains.hpp"
#include "oort/mapping/map.hpp"

namespace oort {

/// Draws the scans of some nodes of one segment into a table, in the frame of `origin`, a node of that segment.
std::shared_ptr<const frsm::Table> draw_submap(const Map& map, const Chains& chains, std::uint64_t origin,
                                               const std::vector<std::uint64_t>& nodes, const frsm::TableParams& table,
                                               const frsm::ContourParams& contours);

/// The returns of some nodes of one segment, in the frame of `origin`, a node of that segment; those farther than
/// `reach` [m] from where they were seen are left out.
frsm::Points gather_points(const Map& map, const Chains& chains, std::uint64_t origin,
                           const std::vector<std::uint64_t>& nodes,
                           double reach = std::numeric_limits<double>::infinity());

/// Submaps of nodes, each drawn when it is first asked for and again after it fell out of the cache. A submap shows a
/// node's neighbourhood in the frame of the node; since it is made from poses that never change, what is cached only
/// decides how long a query takes, never its result.
class SubmapCache {
 public:
  SubmapCache(std::uint64_t neighborhood_size, std::size_t max_bytes, const frsm::TableParams& table,
              const frsm::ContourParams& contours);

  std::shared_ptr<const frsm::Table> get(const Map& map, const Chains& chains, std::uint64_t node);

  /// Draws at most so many more scans of a node's submap. False if it was drawn already.
  bool draw(const Map& map, const Chains& chains, std::uint64_t node, std::uint64_t scans);

 private:
  struct Entry {
    std::uint64_t node;
    std::shared_ptr<frsm::Table> table;
    std::size_t drawn;  // scans; the neighbourhood grows at its end while its node is among the newest
  };
  Entry& latest(std::uint64_t node);
  void draw_more(const Map& map, const Chains& chains, const std::vector<std::uint64_t>& nodes, std::size_t end,
                 Entry& entry) const;
  void forget_oldest();

  std::uint64_t neighborhood_size_;
  std::size_t max_bytes_;
  frsm::TableParams table_;
  frsm::ContourParams contours_;
  std::list<Entry> entries_;  // most recently used first
};

}  // namespace oort
