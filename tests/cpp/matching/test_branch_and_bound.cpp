// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "matching_scenes.hpp"
#include "oort/geometry/errors.hpp"
#include "oort/matching/fast_correlative_matcher.hpp"
#include "oort/matching/grid_score.hpp"

namespace oort {
namespace {

using testing::grid_of_room;
using testing::kPi;
using testing::random_cloud;
using testing::random_grid;
using testing::seen_from;

constexpr ProbabilityGridParameters kGrid{0.05, false, 0.55, 0.49};

/// The score of a pose as branch and bound sees it: cells in steps of 1/255.
double byte_score(const BoundGrids& grids, const Points& points, const Pose2& guess, int dx, int dy, double theta) {
  unsigned sum = 0;
  for (const CellIndex& cell : cells_of(points, {guess.x, guess.y, guess.theta + theta}, grids.grid().limits())) {
    sum += grids.level(0).value(cell.x() + dx, cell.y() + dy);
  }
  return BoundGrid::to_probability(static_cast<double>(sum) / static_cast<double>(points.size()));
}

TEST(BoundGrid, IsTheMaximumOfItsSquareAtEachLevel) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    const BoundGrids grids(random_grid(seed, 23, 17), 5);
    for (int level = 0; level < 5; ++level) {
      const int side = 1 << level;
      for (int row = -side - 1; row < 19; ++row) {
        for (int column = -side - 1; column < 25; ++column) {
          std::uint8_t most = 0;
          for (int y = row; y < row + side; ++y) {
            for (int x = column; x < column + side; ++x) most = std::max(most, grids.level(0).value(x, y));
          }
          ASSERT_EQ(grids.level(level).value(column, row), most) << level << ": " << column << ", " << row;
        }
      }
    }
  }
}

TEST(BoundGrid, BytesAreTheProbabilities) {
  const BoundGrids grids(random_grid(4, 23, 17), 1);
  for (int row = -2; row < 19; ++row) {
    for (int column = -2; column < 25; ++column) {
      EXPECT_NEAR(BoundGrid::to_probability(grids.level(0).value(column, row)), grids.grid().probability(column, row),
                  0.4 / 255.0 + 1e-9);
    }
  }
}

TEST(BranchAndBound, EqualsExhaustiveSearch) {
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    const int depth = 1 + static_cast<int>(seed % 6);
    const auto grids = std::make_shared<BoundGrids>(random_grid(seed, 30, 25), depth);
    const Points points = random_cloud(seed + 50, 8 + seed, 0.6);
    const Pose2 guess{0.3 + 0.01 * seed, 1.2, 0.2 * seed};
    const FastCorrelativeOptions options{0.35, 0.3, 0.0};
    const double turn = angular_step(points, 0.05);
    double best = 0.0;
    for (int k = -static_cast<int>(std::ceil(0.3 / turn)); k <= static_cast<int>(std::ceil(0.3 / turn)); ++k) {
      for (int dy = -7; dy <= 7; ++dy) {
        for (int dx = -7; dx <= 7; ++dx) {
          best = std::max(best, byte_score(*grids, points, guess, dx, dy, k * turn));
        }
      }
    }
    const ScanMatch match = FastCorrelativeMatcher(grids, options).match(points, guess);
    ASSERT_EQ(match.rejection, Rejection::kNone);
    EXPECT_NEAR(match.score, best, 0.4 / 255.0 + 1e-9);
    const Pose2 moved{match.pose.x - guess.x, match.pose.y - guess.y, wrap_angle(match.pose.theta - guess.theta)};
    EXPECT_DOUBLE_EQ(byte_score(*grids, points, guess, static_cast<int>(std::lround(moved.x / 0.05)),
                                static_cast<int>(std::lround(moved.y / 0.05)), moved.theta),
                     best)
        << "seed " << seed;
    // Asked for more than there is, it finds nothing, and for a little less it does.
    EXPECT_EQ(FastCorrelativeMatcher(grids, {0.35, 0.3, best}).match(points, guess).rejection, Rejection::kLowScore);
    EXPECT_EQ(FastCorrelativeMatcher(grids, {0.35, 0.3, best - 1e-9}).match(points, guess).rejection, Rejection::kNone);
  }
}

TEST(BranchAndBound, FindsTheSameAtAnyDepthWithLessWork) {
  const ProbabilityGrid grid = grid_of_room(kGrid);
  const Pose2 truth{-1.4, -0.9, 0.5};
  const Points points = seen_from(truth, 77);
  const Pose2 guess{truth.x + 0.8, truth.y - 0.6, truth.theta - 0.3};
  const FastCorrelativeOptions options{1.5, 0.5, 0.3};
  const ScanMatch all = FastCorrelativeMatcher(std::make_shared<BoundGrids>(grid, 1), options).match(points, guess);
  for (const int depth : {2, 4, 7}) {
    const ScanMatch match =
        FastCorrelativeMatcher(std::make_shared<BoundGrids>(grid, depth), options).match(points, guess);
    EXPECT_EQ(match.score, all.score);
    EXPECT_LT(match.evaluations, all.evaluations);
    EXPECT_LT(between(truth, match.pose).translation().norm(), 0.06);
    EXPECT_NEAR(match.pose.theta, truth.theta, 0.02);
  }
}

TEST(BranchAndBound, FindsAPlaceAtAnyHeadingInAWideWindow) {
  const auto grids = std::make_shared<BoundGrids>(grid_of_room(kGrid), 7);
  const FastCorrelativeMatcher matcher(grids, {10.0, kPi, 0.4});
  for (const Pose2& truth : {Pose2{-1.4, -0.9, 2.5}, Pose2{-2.0, 0.6, -2.9}, Pose2{-2.4, 1.7, 0.4}}) {
    const ScanMatch match = matcher.match(seen_from(truth, 9), {});
    ASSERT_EQ(match.rejection, Rejection::kNone);
    EXPECT_LT(between(truth, match.pose).translation().norm(), 0.07);
    EXPECT_NEAR(wrap_angle(match.pose.theta - truth.theta), 0.0, 0.02);
  }
}

TEST(BranchAndBound, SaysWhatItCannotUse) {
  const ProbabilityGrid grid = grid_of_room(kGrid);
  EXPECT_THROW(BoundGrids(grid, 0), ParameterError);
  EXPECT_THROW(BoundGrids(grid, 17), ParameterError);
  const auto grids = std::make_shared<BoundGrids>(grid, 3);
  EXPECT_THROW(FastCorrelativeMatcher(grids, {-1.0, 0.5, 0.4}), ParameterError);
  EXPECT_THROW(FastCorrelativeMatcher(grids, {1.0, std::nan(""), 0.4}), ParameterError);
  const FastCorrelativeMatcher matcher(grids, {});
  EXPECT_THROW(matcher.match(seen_from({}, 1), {std::nan(""), 0.0, 0.0}), InputError);
  EXPECT_EQ(matcher.match({}, {}).rejection, Rejection::kGridEmptyScan);
}

TEST(BranchAndBound, FindsNothingFarFromTheGrid) {
  const auto grids = std::make_shared<BoundGrids>(grid_of_room(kGrid), 4);
  const ScanMatch match = FastCorrelativeMatcher(grids, {0.5, 0.2, 0.3}).match(seen_from({}, 1), {200.0, 0.0, 0.0});
  EXPECT_EQ(match.rejection, Rejection::kLowScore);
  EXPECT_EQ(match.pose.x, 200.0);
}

}  // namespace
}  // namespace oort
