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
#include "oort/loop_closure/loop_closure_builder.hpp"
#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"
#include "oort/mapper/tuning.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// Closes loops whose ends have drifted farther apart than LoopClosureBuilder searches. Where the graph knows the
/// newest node's place on what was mapped long before so badly, what was seen on the last metres is looked for there
/// (PlaceFinder), now and then; several answers that agree become closures (docs/loops.md).
class DriftSearch {
 public:
  DriftSearch(const Parameters& parameters, const LoopSearch& loops) : loops_(loops), finder_(parameters) {}

  /// A session begins after these nodes.
  void begin(const TrajectorySegments& segments) { schedule(segments, MapperTuning::kDriftSpacing); }
  bool is_due(const TrajectorySegments& segments) const;
  /// Looks for the newest node. Returns closures once answers agree.
  std::vector<Closure> look(const Map& map, const TrajectorySegments& segments, WorkMeter* meter);
  /// When mapping ends: looks for the last nodes from `begin` on, of which some were passed over.
  std::vector<Closure> look_at_end(const Map& map, const TrajectorySegments& segments, std::uint64_t begin);
  /// Closures that it gave are contradicted: looks no more for a while.
  void refuted(const TrajectorySegments& segments);

 private:
  struct Doubt {
    SearchArea area;
    std::size_t max_expansions = 0;
  };
  using Known = std::vector<std::optional<Eigen::Matrix3d>>;  // by node; as seen from the one looked for

  std::vector<Closure> look_for(std::uint64_t node, const Map& map, const TrajectorySegments& segments,
                                WorkMeter* meter);
  Doubt widest(const Map& map, std::uint64_t node);
  bool narrow(Doubt& doubt, const Map& map, const std::vector<std::uint64_t>& older, const Known& known) const;
  bool is_known(std::uint64_t node, const Known& known) const;
  bool says_more(const FoundPlace& answer, const Map& map, const Known& known) const;
  void schedule(const TrajectorySegments& segments, std::uint64_t spacing);

  LoopSearch loops_;
  PlaceFinder finder_;
  std::uint64_t due_ = 0;  // nodes at the usual spacing
  int looks_ = 0;
  int misses_ = 0;  // in a row
  PlaceAnswers answers_;
};

/// Nodes that a solution moved from where they looked for loops, of those that look far (LoopClosureBuilder), and that
/// no closure ties to what was mapped long before.
std::vector<std::uint64_t> nodes_to_look_again(const Map& map, const TrajectorySegments& segments,
                                               const std::vector<Pose2>& poses_before);

}  // namespace oort
