// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/local_slam/local_grids.hpp"

#include <utility>

namespace oort {

LocalGrids::LocalGrids(const std::vector<ProbabilityGridParameters>& grids, int history)
    : parameters_(grids), inserters_(grids.begin(), grids.end()), history_(history) {}

void LocalGrids::insert(const Points& points, const Pose2& T_local_sensor) {
  std::vector<BeamEnd> ends;
  ends.reserve(points.size());
  for (const Eigen::Vector2d& point : points) ends.push_back({T_local_sensor * point, true});
  if (old_.scans == history_) old_ = std::exchange(young_, Generation{});
  insert(T_local_sensor.translation(), ends, old_);
  if (old_.scans > history_ / 2) insert(T_local_sensor.translation(), ends, young_);
}

void LocalGrids::clear() {
  old_ = Generation{};
  young_ = Generation{};
}

void LocalGrids::insert(const Eigen::Vector2d& sensor, const std::vector<BeamEnd>& ends, Generation& generation) const {
  if (generation.scans == 0) {
    Eigen::AlignedBox2d box(sensor);
    for (const BeamEnd& end : ends) box.extend(end.point);
    for (const ProbabilityGridParameters& p : parameters_) {
      generation.grids.emplace_back(GridLimits::enclosing(box, p.resolution));
    }
  }
  for (std::size_t k = 0; k < inserters_.size(); ++k) inserters_[k].insert_growing(sensor, ends, generation.grids[k]);
  ++generation.scans;
}

}  // namespace oort
