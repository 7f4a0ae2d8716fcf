// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <frsm/matcher.hpp>
#include <optional>

#include "oort/geometry/work_meter.hpp"
#include "oort/loop_closure/closure.hpp"
#include "oort/loop_closure/statistics.hpp"
#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// Where the robot stood at the dock: a node and the sensor's pose seen from it.
struct DockPlace {
  std::uint64_t node = 0;
  Pose2 T_node_dock;
};

/// The dock nearest to a node: of the locations in the namespace "dock", or, without any, the first node of the node's
/// segment.
DockPlace nearest_dock(const Map& map, const TrajectorySegments& segments, std::uint64_t query);

/// Says again of a loaded map's dock closures how firm they are. Of all closures they alone lead from the older node to
/// the newer one, as in maps of the original format, and only what was matched is firm.
void make_dock_closures_firm(Map& map, double firmness);

/// Links a node at the dock to the dock's own node by matching what was last seen with what was seen when the dock was
/// first left (docs/loops.md#the-dock).
class DockGraphBuilder {
 public:
  explicit DockGraphBuilder(const Parameters& parameters);

  /// The closure from the dock's node to `query`, a node recorded on the dock: the latest nodes matched together, or,
  /// if that is rejected, fewer and fewer of them. Where too little is seen to match, it is the dock's own place with
  /// the reach of its contacts as two deviations. Counts the attempt, and charges its work.
  std::optional<Closure> find(const Map& map, const TrajectorySegments& segments, std::uint64_t query,
                              ClosureCounts& counts, WorkMeter* meter = nullptr) const;

 private:
  std::optional<Closure> match(const Map& map, const TrajectorySegments& segments, std::uint64_t query,
                               const DockPlace& dock, std::size_t query_size, Rejection& rejection,
                               WorkMeter* meter) const;

  DockGraphBuilderParameters parameters_;
  frsm::TableParams table_;
  frsm::ContourParams contours_;
  frsm::Matcher matcher_;
  Eigen::Matrix3d error_;  // of a match, beyond its own covariance
};

}  // namespace oort
