// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/grid/probability_grid.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// Where a beam ends in the map frame [m], and whether it hit something there.
struct BeamEnd {
  Eigen::Vector2d point;
  bool is_hit = false;
};

/// What a cloud says about the map: its hits, and (with insert_free_space and clear_infs) the ends of the stretches
/// that its beams without return clear, which are inf_clear_dist long. A beam is without return if its range is +inf,
/// or finite but at or beyond the sensor's greatest; the cloud tells the latter from a range below the least by its
/// being longer than inf_clear_dist. A nan range and a range below the least say nothing and are left out.
std::vector<BeamEnd> beam_ends(const PointCloud& cloud, const Pose2& T_map_sensor,
                               const OutputGridParameters& parameters);

/// Inserts what beams say into a grid: the cells of the hits get hit_probability, then (with insert_free_space) the
/// cells that beams crossed on their way get miss_probability. Each cell is updated at most once per call, so that hits
/// win over misses.
class BeamInserter {
 public:
  /// Throws ParameterError if a probability is not one.
  explicit BeamInserter(const ProbabilityGridParameters& parameters);

  /// `sensor`: where the beams start [m], in the grid's frame as their ends are. Returns false, with the grid
  /// unchanged, if the sensor or an end lies outside the grid.
  bool insert(const Eigen::Vector2d& sensor, const std::vector<BeamEnd>& ends, ProbabilityGrid& grid) const;

  /// Grows the grid first, where it must. Throws InputError if the grid cannot grow so far.
  void insert_growing(const Eigen::Vector2d& sensor, const std::vector<BeamEnd>& ends, ProbabilityGrid& grid) const;

 private:
  bool insert_free_space_;
  OddsTable hit_table_;
  OddsTable miss_table_;
};

/// Inserts clouds into a grid: what their beam_ends() say.
class RangeDataInserter {
 public:
  /// Throws ParameterError if a probability is not one or inf_clear_dist is not a distance.
  explicit RangeDataInserter(const OutputGridParameters& parameters);

  /// `T_map_sensor` is the pose at which the cloud was taken. Throws InputError if the sensor or an end of a beam lies
  /// outside the grid (make its limits from beam_ends()); the grid is then unchanged.
  void insert(const PointCloud& cloud, const Pose2& T_map_sensor, ProbabilityGrid& grid) const;

 private:
  OutputGridParameters parameters_;
  BeamInserter inserter_;
};

}  // namespace oort
