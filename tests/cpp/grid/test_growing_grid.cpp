// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "oort/geometry/errors.hpp"
#include "oort/grid/range_data.hpp"

namespace oort {
namespace {

constexpr ProbabilityGridParameters kGrid{0.05, true, 0.55, 0.49};

ProbabilityGrid small_grid() {
  return ProbabilityGrid(GridLimits::enclosing({Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.5, 0.4)}, 0.05));
}

/// The probability of the cell in which a point lies.
double probability_at(const ProbabilityGrid& grid, const Eigen::Vector2d& point) {
  const Eigen::Array2i cell = grid.limits().to_cells(point).array().floor().cast<int>();
  return grid.probability(cell.x(), cell.y());
}

TEST(GrowingGrid, KeepsItsCells) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-3.0, 3.0);
  ProbabilityGrid grid = small_grid();
  const OddsTable hit(0.55);
  std::vector<std::pair<Eigen::Vector2d, double>> known;
  for (int k = 0; k < 60; ++k) {
    const Eigen::Vector2d point = 0.01 * (1.0 + k) * Eigen::Vector2d(coordinate(random), coordinate(random));
    grid.grow(Eigen::AlignedBox2d(point));
    const Eigen::Array2i cell = grid.limits().to_cells(point).array().floor().cast<int>();
    ASSERT_TRUE(grid.limits().contains(cell.x(), cell.y()));
    if (grid.is_known(cell.x(), cell.y())) continue;
    grid.update(grid.limits().index(cell.x(), cell.y()), hit);
    grid.finish_update();
    const Eigen::Vector2d centre = grid.limits().resolution * (cell.cast<double>() + 0.5).matrix() +
                                   Eigen::Vector2d(grid.limits().origin_x, grid.limits().origin_y);
    known.emplace_back(centre, grid.probability(cell.x(), cell.y()));
    for (const auto& [where, probability] : known) EXPECT_EQ(probability_at(grid, where), probability);
  }
  std::size_t count = 0;
  for (const std::uint16_t value : grid.values()) count += value != ProbabilityGrid::kUnknown ? 1 : 0;
  EXPECT_EQ(count, known.size()) << "and makes up none";
}

TEST(GrowingGrid, GrowsOnlyWhereItMust) {
  ProbabilityGrid grid = small_grid();
  const GridLimits before = grid.limits();
  grid.grow(Eigen::AlignedBox2d(Eigen::Vector2d(0.2, 0.2)));
  EXPECT_EQ(grid.limits().width, before.width);
  EXPECT_EQ(grid.limits().height, before.height);
  grid.grow(Eigen::AlignedBox2d(Eigen::Vector2d(0.2, 1.0)));
  EXPECT_EQ(grid.limits().width, before.width);
  EXPECT_EQ(grid.limits().origin_y, before.origin_y);
  EXPECT_GT(grid.limits().height, before.height);
}

TEST(GrowingGrid, RefusesWhatNoGridCanHold) {
  ProbabilityGrid grid = small_grid();
  EXPECT_THROW(grid.grow(Eigen::AlignedBox2d(Eigen::Vector2d(1e9, 0.0))), InputError);
  EXPECT_THROW(grid.grow(Eigen::AlignedBox2d(Eigen::Vector2d(1e4, 1e4))), InputError);
  EXPECT_THROW(grid.grow(Eigen::AlignedBox2d(Eigen::Vector2d(std::numeric_limits<double>::infinity(), 0.0))),
               InputError);
  EXPECT_THROW(grid.grow(Eigen::AlignedBox2d()), InputError);
  EXPECT_EQ(grid.limits().width, small_grid().limits().width);
}

TEST(BeamInserter, GrowsTheGridToHoldTheBeams) {
  const BeamInserter inserter(kGrid);
  const Eigen::Vector2d sensor(0.12, 0.13);
  const std::vector<BeamEnd> ends{{{3.33, 0.41}, true}, {{-2.07, 1.92}, true}, {{0.4, -1.0}, false}};
  ProbabilityGrid grid = small_grid();
  EXPECT_FALSE(inserter.insert(sensor, ends, grid));
  EXPECT_EQ(grid.values(), small_grid().values()) << "nothing changed";
  inserter.insert_growing(sensor, ends, grid);
  EXPECT_NEAR(probability_at(grid, ends[0].point), 0.55, 1e-4);
  EXPECT_NEAR(probability_at(grid, ends[1].point), 0.55, 1e-4);
  EXPECT_NEAR(probability_at(grid, ends[2].point), 0.49, 1e-4);
  EXPECT_NEAR(probability_at(grid, sensor), 0.49, 1e-4) << "once, though three beams crossed it";
  inserter.insert_growing(sensor, ends, grid);
  EXPECT_NEAR(probability_at(grid, ends[0].point), 0.599, 1e-3) << "odds 0.55 / 0.45 squared";
}

}  // namespace
}  // namespace oort
