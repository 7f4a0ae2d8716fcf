// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "oort/geometry/work_meter.hpp"
#include "oort/localization/place_tuning.hpp"
#include "oort/localization/relocalizer.hpp"
#include "oort/loop_closure/closure.hpp"
#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// Where a node lies, by what it and the nodes before it saw.
struct FoundPlace {
  std::uint64_t node = 0;
  Pose2 T_map_node;
  Eigen::Matrix3d covariance;  ///< along the axes of the map
  bool is_weak = false;        ///< much of what was seen lies where nothing is known
};

/// What a search for a node came to.
struct Look {
  std::optional<FoundPlace> answer;  ///< if the place was found, and is not ambiguous
  bool fits_nowhere = false;         ///< no place of the map looks like what was seen
};

/// How a node is looked for.
struct PlaceSearch {
  double view_spacing = 0.0;       ///< [m] between the views that are looked for together; 0: each of the nodes before
  std::optional<SearchArea> area;  ///< of the map, if it is not looked for everywhere
  std::size_t max_expansions = PlaceTuning::kSearchExpansions;
  double least_support = PlaceTuning::kWeakSupport;  ///< of an answer
  /// Whether an answer of less support than a robot is found with on a saved map counts half, and not at all where
  /// something speaks against it.
  bool weighs = true;
};

/// Finds nodes on a part of the map that they do not hang on, at all headings and without a guess (Relocalizer).
class PlaceFinder {
 public:
  explicit PlaceFinder(const Parameters& parameters) : parameters_(parameters) {}

  /// Looks on these nodes from now on, or on what was drawn of earlier ones if they are few more: then places are
  /// moved as the drawn nodes next to them were. `anew`: not if there are any more, or if a solution has moved them.
  /// One is drawn each `spacing` [m] of the way. False if they are too far apart to be drawn.
  bool use(const Map& map, const std::vector<std::uint64_t>& nodes, bool anew, WorkMeter* meter, double spacing = 0.0);
  void forget();

  /// By what a node saw and those before it, none before `first`.
  Look find(const Map& map, const TrajectorySegments& segments, std::uint64_t first, std::uint64_t node,
            WorkMeter* meter, const PlaceSearch& search = {}) const;

  /// How what they saw fits where the map has the node.
  struct Fit {
    bool contradicts = false;  ///< it cannot be there: much of it is behind walls, or on free floor
    bool confirms = false;     ///< most of it lies on known surfaces
  };
  Fit fit(const Map& map, const TrajectorySegments& segments, std::uint64_t first, std::uint64_t node,
          WorkMeter* meter) const;

  /// Whether the graph knows its way to the place so badly that the answer is where the node may well be.
  bool may_have_drifted(const FoundPlace& answer, const Map& map) const;
  /// The same with what the graph knows of that way, if anything (RelativeUncertainty).
  bool may_have_drifted(const FoundPlace& answer, const Map& map, const std::optional<Eigen::Matrix3d>& known) const;

  /// The drawn node that is nearest to the place,
  std::uint64_t nearest(const FoundPlace& place, const Map& map) const {
    return nodes_[nearest_to(map, place.T_map_node)];
  }
  /// and what leads there.
  Closure closure(const FoundPlace& place, const Map& map) const;

 private:
  bool has_moved(const Map& map) const;
  void draw(const Map& map, const std::vector<std::uint64_t>& nodes, double spacing, WorkMeter* meter);
  Pose2 drawn(const Map& map, const Pose2& pose) const;
  std::size_t nearest_drawn(const Pose2& T_drawn_node) const;
  std::size_t nearest_to(const Map& map, const Pose2& T_map_node) const;

  Parameters parameters_;
  std::vector<std::uint64_t> given_;  // nodes to look on, and those of them
  std::vector<std::uint64_t> nodes_;  // that are drawn,
  std::vector<Pose2> poses_;          // where they were then
  std::uint64_t drawn_at_ = 0;        // number of nodes of the whole map then
  std::shared_ptr<const ReferenceMap> reference_;
  std::unique_ptr<Relocalizer> relocalizer_;
};

/// Whether two answers agree: the second place is where the trajectory leads from the first.
bool agree(const FoundPlace& a, const FoundPlace& b, const Pose2& T_a_b);

}  // namespace oort
