// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "oort/geometry/work_meter.hpp"
#include "oort/localization/place_answers.hpp"
#include "oort/localization/place_finder.hpp"
#include "oort/loop_closure/closure.hpp"
#include "oort/map/map.hpp"
#include "oort/map/node_range.hpp"
#include "oort/map/trajectory_segments.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// What looking for untied nodes on the rest of the map leads to.
struct SegmentFinding {
  std::vector<NodeRange> nodes;   ///< that it is about
  bool disproved = false;         ///< they are not where the map has them: what they hang on tells nothing
  bool begins_segment = false;    ///< nor does the local map that the first of them shares with those before
  bool withdrawn = false;         ///< nor do the closures that tie them
  std::vector<Closure> closures;  ///< that tie them to where they are
  Pose2 T_new_old;                ///< and their motion on the map that brings them there
  std::optional<bool> trusted;    ///< whether they are where the map has them, if that is to be told anew

  bool is_nothing() const { return !disproved && closures.empty() && !trusted; }
};

/// What of a place is in doubt.
enum class Doubt {
  kOdometry,  ///< a new local map was begun, as scans did not fit: where odometry leads is likely
  kAll,       ///< nothing tells where it is: after a pause, in a session
  kMap,       ///< scans go on fitting each other, but not what was seen there before (PlaceWatch)
};

/// Looks on the whole map, at all headings, for a segment of which nothing tells where it is: after a pause, in a
/// session, after a kidnapping (docs/tracking.md). What the newest nodes saw is looked for again and again while the
/// robot drives on, ever more rarely. An unambiguous answer counts once others from elsewhere agree with it. A
/// segment that closures have tied meanwhile is looked for, too, until answers confirm where they put it.
class SegmentSearch {
 public:
  explicit SegmentSearch(const Parameters& parameters) : finder_(parameters) {}

  /// From this node on the place is not known.
  void begin(std::uint64_t first_node, Doubt doubt);
  /// From this node on the newest ones contradict the map; nothing if there is a doubt already.
  void suspect(std::uint64_t first_node, const TrajectorySegments& segments);
  void forget() { first_.reset(); }

  bool is_looking() const { return first_.has_value(); }
  /// Whether nothing tells where the newest nodes are.
  bool is_lost() const { return first_ && doubt_ == Doubt::kAll; }
  bool is_due(std::uint64_t node_count) const { return first_ && node_count >= due_; }

  /// Looks for the newest node.
  SegmentFinding look(const Map& map, const TrajectorySegments& segments, WorkMeter* meter);

  /// Whether a closure is of those that put the segment where it is not.
  bool refuses(const Closure& closure) const;

  /// Looks with all that was seen for every part of the map that no closure ties to the main part, and says what is
  /// found. First for those of which nothing at all tells where they are, then for those that contradict the map where
  /// odometry has them, as far as the budget lasts.
  std::vector<SegmentFinding> look_for_all(const Map& map, const TrajectorySegments& segments, WorkBudget& budget);

 private:
  void schedule(std::uint64_t count, bool contradicts);
  SegmentFinding ended();
  bool is_over(const Map& map, bool is_tied) const;
  void weigh_tie(bool is_tied, bool contradicts);
  bool contradicts_mostly() const;
  std::optional<bool> trust(const Look& look, const PlaceFinder::Fit& fit);
  SegmentFinding take(const FoundPlace& answer, std::uint64_t first, const Map& map);
  SegmentFinding take_suspect(const FoundPlace& answer, std::uint64_t first, const Map& map);
  std::vector<NodeRange> most_doubtful_first(const Map& map, const TrajectorySegments& segments,
                                             const std::vector<std::uint64_t>& parts, std::uint64_t main,
                                             WorkBudget& budget) const;
  double contradicting_share(const NodeRange& segment, const Map& map, const TrajectorySegments& segments,
                             WorkBudget& budget) const;
  SegmentFinding look_for(const NodeRange& segment, const Map& map, const TrajectorySegments& segments,
                          WorkBudget& budget) const;
  SegmentFinding placed(const PlaceAnswers& answers, const Map& map) const;

  PlaceFinder finder_;
  std::optional<std::uint64_t> first_;
  std::uint64_t due_ = 0;   // number of nodes at which it is looked for next
  bool was_found_ = false;  // by a search, not by closures alone
  Doubt doubt_ = Doubt::kOdometry;
  bool is_distrusted_ = false;      // closures put it where it is not
  int looks_tied_ = 0;              // looks since it is tied,
  int contradictions_ = 0;          // and those that contradict where it is
  int quiet_looks_ = 0;             // in a row that tell nothing
  std::uint64_t suspect_from_ = 0;  // the least number of nodes at which the map may be doubted again
  PlaceAnswers answers_;
};

}  // namespace oort
