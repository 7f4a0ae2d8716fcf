// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <random>
#include <vector>

#include "mapping_fixtures.hpp"
#include "oort/geometry/points.hpp"
#include "oort/grid/range_data.hpp"

/// What the tests of the matchers on probability grids share.
namespace oort::testing {

/// What a sensor sees from a place of the room, with some noise on the ranges, in the sensor's frame.
inline Points seen_from(const Pose2& T_world_sensor, std::uint32_t seed, const Sensor& sensor = kAllRound) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.005);
  Points points;
  for (const Point2& point : to_point_cloud(see(make_room(), T_world_sensor, 0.0, sensor)).points) {
    if (point.is_return()) points.push_back((1.0 + noise(random)) * Eigen::Vector2d(point.x, point.y));
  }
  return points;
}

/// A grid of the room, seen from some places on a walk.
inline ProbabilityGrid grid_of_room(const ProbabilityGridParameters& parameters, std::uint32_t seed = 1) {
  ProbabilityGrid grid(
      GridLimits::enclosing({Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(0.5, 0.5)}, parameters.resolution));
  const BeamInserter inserter(parameters);
  for (int k = 0; k < 12; ++k) {
    const Pose2 pose{-2.2 + 0.15 * k, -1.2 + 0.05 * k, 0.1 * k};
    std::vector<BeamEnd> ends;
    for (const Eigen::Vector2d& point : seen_from(pose, seed + static_cast<std::uint32_t>(k))) {
      ends.push_back({pose * point, true});
    }
    inserter.insert_growing(pose.translation(), ends, grid);
  }
  return grid;
}

/// Cells of any value, a third of them unknown.
inline ProbabilityGrid random_grid(std::uint32_t seed, int width, int height) {
  std::mt19937 random(seed);
  ProbabilityGrid grid(GridLimits{0.05, -0.4, 0.7, width, height});
  std::vector<OddsTable> tables;
  for (int k = 1; k < 10; ++k) tables.emplace_back(0.09 * k + 0.05);
  for (std::size_t cell = 0; cell < grid.limits().cell_count(); ++cell) {
    if (random() % 3 != 0) grid.update(cell, tables[random() % tables.size()]);
  }
  grid.finish_update();
  return grid;
}

inline Points random_cloud(std::uint32_t seed, std::size_t count, double reach) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-reach, reach);
  Points points;
  while (points.size() < count) points.push_back({coordinate(random), coordinate(random)});
  return points;
}

}  // namespace oort::testing
