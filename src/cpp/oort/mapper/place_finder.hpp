// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "oort/geometry/work_meter.hpp"
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
};

/// Finds nodes on a part of the map that they do not hang on, at all headings and without a guess (Relocalizer).
class PlaceFinder {
 public:
  explicit PlaceFinder(const Parameters& parameters) : parameters_(parameters) {}

  /// Looks on these nodes from now on, or on what was drawn of earlier ones if they are few more: then places are
  /// moved as the drawn nodes next to them were. `anew`: not if there are any more, or if a solution has moved them.
  /// False if they are too far apart to be drawn.
  bool use(const Map& map, const std::vector<std::uint64_t>& nodes, bool anew, WorkMeter* meter);
  void forget();

  /// By what a node saw and those before it, none before `first`. None unless the place is found and not ambiguous.
  std::optional<FoundPlace> find(const Map& map, const TrajectorySegments& segments, std::uint64_t first,
                                 std::uint64_t node, WorkMeter* meter) const;

  /// Whether what they saw cannot be where the map has the node.
  bool contradicts(const Map& map, const TrajectorySegments& segments, std::uint64_t first, std::uint64_t node,
                   WorkMeter* meter) const;

  /// To the drawn node that is nearest to the place.
  Closure closure(const FoundPlace& place, const Map& map) const;

 private:
  bool has_moved(const Map& map) const;
  void draw(const Map& map, const std::vector<std::uint64_t>& nodes, WorkMeter* meter);
  std::size_t nearest_drawn(const Pose2& T_drawn_node) const;
  std::size_t nearest_to(const Map& map, const Pose2& T_map_node) const;

  Parameters parameters_;
  std::vector<std::uint64_t> nodes_;
  std::vector<Pose2> poses_;    // when they were drawn
  std::uint64_t drawn_at_ = 0;  // number of nodes of the whole map then
  std::shared_ptr<const ReferenceMap> reference_;
  std::unique_ptr<Relocalizer> relocalizer_;
};

/// Whether two answers agree: the second place is where the trajectory leads from the first.
bool agree(const FoundPlace& a, const FoundPlace& b, const Pose2& T_a_b);

}  // namespace oort
