// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "oort/geometry/errors.hpp"
#include "oort/grid/range_data.hpp"
#include "oort/grid/ray.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

Eigen::AlignedBox2d box(double x0, double y0, double x1, double y1) {
  return {Eigen::Vector2d(x0, y0), Eigen::Vector2d(x1, y1)};
}

TEST(GridLimits, EndAtTheUpperCornerOfTheBox) {
  const GridLimits limits = GridLimits::enclosing(box(-1.02, 0.5, 2.0, 1.5), 0.5);
  EXPECT_EQ(limits.width, 7);  // 3.02 m need 6.04 cells
  EXPECT_EQ(limits.height, 2);
  EXPECT_DOUBLE_EQ(limits.origin_x + limits.width * limits.resolution, 2.0);
  EXPECT_DOUBLE_EQ(limits.origin_y, 0.5);
}

TEST(GridLimits, APointGetsOneCell) {
  const GridLimits limits = GridLimits::enclosing(box(3.0, 4.0, 3.0, 4.0), 0.05);
  EXPECT_EQ(limits.cell_count(), 1U);
}

TEST(GridLimits, RefusesWhatNoGridCanHold) {
  EXPECT_THROW(GridLimits::enclosing(box(0, 0, 1e9, 1), 0.05), InputError);
  EXPECT_THROW(GridLimits::enclosing(box(0, 0, 1e300, 1e300), 0.05), InputError);
  EXPECT_THROW(GridLimits::enclosing(box(0, 0, kNan, 1), 0.05), InputError);
  EXPECT_THROW(GridLimits::enclosing(Eigen::AlignedBox2d(), 0.05), InputError);
  EXPECT_THROW(GridLimits::enclosing(box(0, 0, 1, 1), 0.0), ParameterError);
  EXPECT_THROW(GridLimits::enclosing(box(0, 0, 1, 1), kNan), ParameterError);
}

class OneCell : public ::testing::Test {
 protected:
  void observe(const OddsTable& table, int times = 1) {
    for (int i = 0; i < times; ++i) {
      grid_.update(0, table);
      grid_.finish_update();
    }
  }
  double probability() const { return grid_.probability(0, 0); }

  ProbabilityGrid grid_{GridLimits::enclosing(box(0, 0, 0.05, 0.05), 0.05)};
  const OddsTable hit_{0.55};
  const OddsTable miss_{0.49};
  static constexpr double kStep = 0.8 / 32766.0;  // of the 15-bit values
};

TEST_F(OneCell, IsUnknownAtFirst) {
  EXPECT_FALSE(grid_.is_known(0, 0));
  EXPECT_EQ(probability(), ProbabilityGrid::kMinProbability);
  EXPECT_FALSE(grid_.is_known(-1, 0));
  EXPECT_FALSE(grid_.is_known(0, 1));
}

TEST_F(OneCell, MultipliesOdds) {
  observe(hit_);
  EXPECT_NEAR(probability(), 0.55, kStep);
  observe(miss_);
  const double odds = 0.55 / 0.45 * 0.49 / 0.51;
  EXPECT_NEAR(probability(), odds / (1.0 + odds), 2.0 * kStep);
}

TEST_F(OneCell, TwoMissesAreFortyEightPercent) {
  observe(miss_, 2);
  EXPECT_NEAR(probability(), 0.480006, 2.0 * kStep);
}

TEST_F(OneCell, ClampsAndRecovers) {
  observe(hit_, 1000);
  EXPECT_NEAR(probability(), ProbabilityGrid::kMaxProbability, kStep);
  observe(miss_, 1000);
  EXPECT_NEAR(probability(), ProbabilityGrid::kMinProbability, kStep);
  observe(hit_, 22);  // odds 1/9 to 9 take 2 ln 9 / ln(0.55 / 0.45) = 21.9 hits
  EXPECT_NEAR(probability(), ProbabilityGrid::kMaxProbability, kStep);
}

TEST_F(OneCell, TakesOneObservationPerUpdate) {
  grid_.update(0, hit_);
  grid_.update(0, hit_);
  grid_.update(0, miss_);
  grid_.finish_update();
  EXPECT_NEAR(probability(), 0.55, kStep);
}

TEST(OddsTable, RefusesWhatIsNoProbability) {
  for (const double bad : {0.0, 1.0, -0.1, kNan}) EXPECT_THROW(OddsTable{bad}, ParameterError) << bad;
}

constexpr int kWidth = 12;

std::vector<std::size_t> cells_of_ray(const SubcellPoint& begin, const SubcellPoint& end) {
  std::vector<std::size_t> cells;
  visit_ray(begin, end, kWidth, [&](std::size_t index) { cells.push_back(index); });
  return cells;
}

SubcellPoint in_cell(int column, int row, int x = 512, int y = 512) {
  return {column * kSubcells + x, row * kSubcells + y};
}

TEST(Ray, GoesStraight) {
  EXPECT_EQ(cells_of_ray(in_cell(2, 1), in_cell(5, 1)), (std::vector<std::size_t>{14, 15, 16, 17}));
  EXPECT_EQ(cells_of_ray(in_cell(2, 3), in_cell(2, 1)), (std::vector<std::size_t>{38, 26, 14}));
  EXPECT_EQ(cells_of_ray(in_cell(4, 4), in_cell(4, 4, 1, 2)), (std::vector<std::size_t>{52}));
}

TEST(Ray, PassesACornerToTheCellAcross) {
  EXPECT_EQ(cells_of_ray(in_cell(0, 0), in_cell(2, 2)), (std::vector<std::size_t>{0, 13, 26}));
  EXPECT_EQ(cells_of_ray(in_cell(2, 0, 511), in_cell(0, 2, 511)), (std::vector<std::size_t>{2, 13, 24}));
}

/// The length of the part of a segment that lies inside a cell, as a share of the segment (Liang and Barsky 1984).
double share_inside(const SubcellPoint& begin, const SubcellPoint& end, int column, int row) {
  double enter = 0.0;
  double leave = 1.0;
  const double from[2] = {static_cast<double>(begin.x) + 0.5, static_cast<double>(begin.y) + 0.5};
  const double way[2] = {static_cast<double>(end.x - begin.x), static_cast<double>(end.y - begin.y)};
  const int cell[2] = {column, row};
  for (int axis = 0; axis < 2; ++axis) {
    const double low = static_cast<double>(cell[axis] * kSubcells) - from[axis];
    const double high = low + static_cast<double>(kSubcells);
    if (way[axis] == 0.0) {
      if (low > 0.0 || high < 0.0) return -1.0;
      continue;
    }
    enter = std::max(enter, std::min(low / way[axis], high / way[axis]));
    leave = std::min(leave, std::max(low / way[axis], high / way[axis]));
  }
  return leave - enter;
}

TEST(Ray, VisitsExactlyTheCellsItCrosses) {
  std::mt19937 engine(5);
  std::uniform_int_distribution<std::int64_t> anywhere(0, kWidth * kSubcells - 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const SubcellPoint begin{anywhere(engine), anywhere(engine)};
    const SubcellPoint end{anywhere(engine), anywhere(engine)};
    const std::vector<std::size_t> visited = cells_of_ray(begin, end);
    const std::set<std::size_t> once(visited.begin(), visited.end());
    ASSERT_EQ(once.size(), visited.size());
    for (int row = 0; row < kWidth; ++row) {
      for (int column = 0; column < kWidth; ++column) {
        const double share = share_inside(begin, end, column, row);
        const bool is_visited = once.count(static_cast<std::size_t>(row * kWidth + column)) != 0;
        if (std::abs(share) < 1e-9) continue;  // through a corner
        ASSERT_EQ(is_visited, share > 0.0) << "trial " << trial << " cell " << column << ", " << row;
      }
    }
  }
}

/// A sensor at (0.25, 0.25), the middle of cell (2, 2) of a grid of 0.1 m cells from (0, 0) to (2, 1).
class Inserting : public ::testing::Test {
 protected:
  Inserting() {
    parameters_.resolution = 0.1;
    parameters_.inf_clear_dist = 0.5;
  }

  /// The columns of row 2 that a cloud with one beam makes known: 'h' more, 'm' less likely occupied than not.
  std::string insert(std::vector<Point2> points) {
    ProbabilityGrid grid(GridLimits::enclosing(box(0, 0, 2, 1), 0.1));
    RangeDataInserter(parameters_).insert({0, 0.0, std::move(points)}, {0.25, 0.25, 0.0}, grid);
    std::string row;
    for (int column = 0; column < grid.limits().width; ++column) {
      const bool is_hit = grid.probability(column, 2) > 0.5;
      row += !grid.is_known(column, 2) ? '.' : is_hit ? 'h' : 'm';
    }
    return row;
  }

  OutputGridParameters parameters_ = Parameters().output_map.probability_grid;
};

TEST_F(Inserting, MarksTheHitAndTheWayToIt) {
  EXPECT_EQ(insert({{0.72, 0.0, 1.0}}), "..mmmmmmmh..........");
}

TEST_F(Inserting, ABeamDoesNotMissWhatAnotherHits) {
  EXPECT_EQ(insert({{1.42, 0.0, 1.0}, {0.72, 0.0, 1.0}}), "..mmmmmmmhmmmmmmh...");
}

TEST_F(Inserting, InfinityClearsItsFirstStretch) {
  EXPECT_EQ(insert({{kInf, 0.0, kNan}}), "..mmmmmm............");
}

TEST_F(Inserting, InfinityClearsAlongItsBearing) {
  EXPECT_EQ(insert({{kInf, M_PI / 2, kNan}}), "..m.................");
}

TEST_F(Inserting, AReadingBeyondTheMaximumCountsAsInfinity) {
  EXPECT_EQ(insert({{1.5, 0.0, kNan}}), "..mmmmmm............");
}

TEST_F(Inserting, WhatSaysNothingChangesNothing) {
  EXPECT_EQ(insert({{kNan, 0.0, kNan}}), "....................");
  EXPECT_EQ(insert({{-kInf, 0.0, kNan}}), "....................");
  EXPECT_EQ(insert({{0.3, 0.0, kNan}}), "....................") << "below the sensor's minimum";
}

TEST_F(Inserting, InfinityNeedNotClear) {
  parameters_.clear_infs = false;
  EXPECT_EQ(insert({{kInf, 0.0, kNan}, {1.5, 0.0, kNan}}), "....................");
}

TEST_F(Inserting, FreeSpaceNeedNotBeInserted) {
  parameters_.insert_free_space = false;
  EXPECT_EQ(insert({{0.72, 0.0, 1.0}, {kInf, 0.0, kNan}}), ".........h..........");
}

TEST_F(Inserting, AHitOnTheUpperCornerIsInTheLastCell) {
  EXPECT_EQ(insert({{1.75, 0.0, 1.0}}).back(), 'h');
}

TEST_F(Inserting, OutsideTheGridIsAnErrorThatNamesTheNodeAndChangesNothing) {
  ProbabilityGrid grid(GridLimits::enclosing(box(0, 0, 2, 1), 0.1));
  const RangeDataInserter inserter(parameters_);
  const PointCloud cloud{7, 0.0, {{0.5, 0.0, 1.0}, {5.0, 0.0, 1.0}}};
  try {
    inserter.insert(cloud, {0.25, 0.25, 0.0}, grid);
    FAIL() << "no exception";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("node 7"), std::string::npos) << error.what();
  }
  EXPECT_THROW(inserter.insert({7, 0.0, {}}, {kNan, 0.0, 0.0}, grid), InputError);
  for (const std::uint16_t value : grid.values()) ASSERT_EQ(value, ProbabilityGrid::kUnknown);
}

TEST_F(Inserting, RefusesBadParameters) {
  parameters_.inf_clear_dist = kInf;
  EXPECT_THROW(RangeDataInserter{parameters_}, ParameterError);
  parameters_.inf_clear_dist = 0.5;
  parameters_.hit_probability = 1.0;
  EXPECT_THROW(RangeDataInserter{parameters_}, ParameterError);
}

TEST(BeamEnds, AreInTheMapFrame) {
  const auto parameters = Parameters().output_map.probability_grid;
  const auto ends = beam_ends({0, 0.0, {{1.0, 0.0, 1.0}, {kInf, M_PI / 2, kNan}}}, {2.0, 3.0, M_PI / 2}, parameters);
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_TRUE(ends[0].is_hit);
  EXPECT_LT((ends[0].point - Eigen::Vector2d(2.0, 4.0)).norm(), 1e-12);
  EXPECT_FALSE(ends[1].is_hit);
  EXPECT_LT((ends[1].point - Eigen::Vector2d(1.5, 3.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace oort
