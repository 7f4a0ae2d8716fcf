// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "oort/geometry/points.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/grid/range_data.hpp"

namespace oort {

/// The latest scans, drawn into probability grids of some resolutions. A cell's odds cannot forget a scan, so there are
/// two generations (as in Hess et al. 2016, section IV-B, submaps overlap by half): `history` scans at most are in the
/// one that is matched against, and when it is full, the one begun in the meantime, with half as many, takes its place.
class LocalGrids {
 public:
  /// One grid per element, from coarse to fine. `history`: at least 2 scans.
  LocalGrids(const std::vector<ProbabilityGridParameters>& grids, int history);

  bool empty() const { return old_.scans == 0; }
  int scans() const { return old_.scans; }
  const ProbabilityGrid& grid(std::size_t index) const { return old_.grids[index]; }

  /// Draws a scan. `points`: its returns in the sensor frame.
  void insert(const Points& points, const Pose2& T_local_sensor);

  void clear();

 private:
  struct Generation {
    int scans = 0;
    std::vector<ProbabilityGrid> grids;
  };
  void insert(const Eigen::Vector2d& sensor, const std::vector<BeamEnd>& ends, Generation& generation) const;

  std::vector<ProbabilityGridParameters> parameters_;
  std::vector<BeamInserter> inserters_;
  int history_;
  Generation old_;    // matched against
  Generation young_;  // takes its place
};

}  // namespace oort
