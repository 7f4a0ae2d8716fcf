// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <utility>
#include <vector>

#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"

namespace oort {

/// Submaps of nodes, each drawn when it is first asked for and again after it fell out of the cache. A submap shows a
/// node's neighbourhood in the frame of the node; since it is made from poses that never change, what is cached only
/// decides how long a query takes, never its result. `Submap` has bytes().
template <class Submap>
class SubmapCache {
 public:
  /// Draws the scans of some nodes of a neighbourhood, in the frame of its node. The first `drawn` of them are in
  /// `so_far` already, null if none are: the others may be added to it, or all be drawn anew.
  using Draw = std::function<std::shared_ptr<Submap>(const Map&, const TrajectorySegments&, std::uint64_t node,
                                                     const std::vector<std::uint64_t>& nodes, std::size_t drawn,
                                                     const std::shared_ptr<Submap>& so_far)>;

  SubmapCache(std::uint64_t neighborhood_size, std::size_t max_bytes, Draw draw)
      : neighborhood_size_(neighborhood_size), max_bytes_(max_bytes), draw_(std::move(draw)) {}

  std::shared_ptr<const Submap> get(const Map& map, const TrajectorySegments& segments, std::uint64_t node) {
    const std::vector<std::uint64_t> nodes = segments.neighborhood(node, neighborhood_size_);
    draw_more(map, segments, nodes, latest(node));
    forget_oldest();
    return entries_.front().submap;
  }

  /// The scans of a node's submap that are not drawn yet.
  std::size_t undrawn(const TrajectorySegments& segments, std::uint64_t node) {
    return segments.neighborhood(node, neighborhood_size_).size() - latest(node).drawn;
  }

  /// Draws at most so many more scans of a node's submap. False if it was drawn already.
  bool draw(const Map& map, const TrajectorySegments& segments, std::uint64_t node, std::size_t scans) {
    std::vector<std::uint64_t> nodes = segments.neighborhood(node, neighborhood_size_);
    Entry& entry = latest(node);
    if (entry.drawn == nodes.size()) return false;
    if (nodes.size() - entry.drawn > scans) nodes.resize(entry.drawn + scans);
    draw_more(map, segments, nodes, entry);
    return true;
  }

 private:
  struct Entry {
    std::uint64_t node;
    std::shared_ptr<Submap> submap;
    std::size_t drawn;  // scans; the neighbourhood grows at its end while its node is among the newest
  };

  Entry& latest(std::uint64_t node) {
    const auto found =
        std::find_if(entries_.begin(), entries_.end(), [node](const Entry& entry) { return entry.node == node; });
    if (found != entries_.end()) {
      entries_.splice(entries_.begin(), entries_, found);
    } else {
      entries_.push_front({node, nullptr, 0});
    }
    return entries_.front();
  }

  void draw_more(const Map& map, const TrajectorySegments& segments, const std::vector<std::uint64_t>& nodes,
                 Entry& entry) const {
    if (entry.drawn == nodes.size()) return;
    entry.submap = draw_(map, segments, entry.node, nodes, entry.drawn, entry.submap);
    entry.drawn = nodes.size();
  }

  /// Submaps may grow after they were handed out, when their bounds for branch and bound are built: count them anew.
  void forget_oldest() {
    std::size_t bytes = 0;
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
      bytes += entry->submap->bytes();
      if (bytes > max_bytes_ && entry != entries_.begin()) {
        entries_.erase(entry, entries_.end());
        return;
      }
    }
  }

  std::uint64_t neighborhood_size_;
  std::size_t max_bytes_;
  Draw draw_;
  std::list<Entry> entries_;  // most recently used first
};

}  // namespace oort
