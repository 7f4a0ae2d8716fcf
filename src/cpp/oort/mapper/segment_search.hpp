// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "oort/geometry/work_meter.hpp"
#include "oort/loop_closure/closure.hpp"
#include "oort/map/map.hpp"
#include "oort/map/node_range.hpp"
#include "oort/map/trajectory_segments.hpp"
#include "oort/mapper/place_finder.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// What looking for untied nodes on the rest of the map leads to.
struct SegmentFinding {
  std::vector<NodeRange> nodes;   ///< that it is about
  bool disproved = false;         ///< they are not where the map has them: what they hang on tells nothing
  bool withdrawn = false;         ///< nor do the closures that tie them
  std::vector<Closure> closures;  ///< that tie them to where they are
  Pose2 T_new_old;                ///< and their motion on the map that brings them there

  bool is_nothing() const { return !disproved && closures.empty(); }
};

/// Looks on the whole map, at all headings, for a segment of which nothing tells where it is: after a pause, in a
/// session, after a kidnapping (docs/tracking.md). What the newest nodes saw is looked for again and again while the
/// robot drives on, ever more rarely. An unambiguous answer counts once others from elsewhere agree with it. A
/// segment that closures have tied meanwhile is looked for, too, until answers confirm where they put it.
class SegmentSearch {
 public:
  explicit SegmentSearch(const Parameters& parameters) : finder_(parameters) {}

  /// From this node on the place is not known. `is_unknown`: nothing is known of it at all.
  void begin(std::uint64_t first_node, bool is_unknown);
  void forget() { first_.reset(); }

  bool is_looking() const { return first_.has_value(); }
  bool is_due(std::uint64_t node_count) const { return first_ && node_count >= due_; }

  /// Looks for the newest node.
  SegmentFinding look(const Map& map, const TrajectorySegments& segments, WorkMeter* meter);

  /// Whether a closure is of those that put the segment where it is not.
  bool refuses(const Closure& closure) const;

  /// Looks with all that was seen for every part of the map that no closure ties to the main part, and says what is
  /// found. `looks_left`: how many times it may look.
  std::vector<SegmentFinding> look_for_all(const Map& map, const TrajectorySegments& segments, int& looks_left);

 private:
  void weigh_tie(bool is_tied, bool contradicts);
  SegmentFinding take(const FoundPlace& answer, std::uint64_t first, const Map& map);
  SegmentFinding look_for(const NodeRange& segment, const Map& map, const TrajectorySegments& segments,
                          int& looks_left) const;
  SegmentFinding placed(const std::vector<FoundPlace>& answers, const Map& map) const;

  PlaceFinder finder_;
  std::optional<std::uint64_t> first_;
  std::uint64_t due_ = 0;            // number of nodes at which it is looked for next
  bool was_found_ = false;           // by a search, not by closures alone
  bool is_unknown_ = false;          // nothing at all tells where it is
  bool is_distrusted_ = false;       // closures put it where it is not
  int looks_tied_ = 0;               // looks since it is tied,
  int contradictions_ = 0;           // and those that contradict where it is
  std::vector<FoundPlace> answers_;  // that agree with each other, the oldest first
};

}  // namespace oort
