// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// The search itself: vector sums against plain ones, bounds, and branch and bound against trying all.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pyramid.hpp"
#include "scene.hpp"
#include "search.hpp"
#include "slice.hpp"

namespace frsm {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  std::mt19937& engine() { return engine_; }

 private:
  std::mt19937 engine_;
};

Table random_table(Random* random) {
  Table table;
  Points points;
  const int n = random->integer(2, 60);
  for (int i = 0; i < n; ++i) points.push_back({random->real(-2.0, 2.0), random->real(-1.0, 1.0)});
  table.draw(points, extract_contours(points, ContourParams::utm()), {});
  return table;
}

std::uint32_t plain_sum(const Table& table, const std::vector<Cell>& cells, int ix, int iy) {
  std::uint32_t sum = 0;
  for (const Cell& cell : cells) sum += table.value(cell.x + ix, cell.y + iy);
  return sum;
}

// More than 256 points, so that the 16-bit sums are flushed; some on the table, some partly and some wholly off
// it.
TEST(Slice, EqualsPlainSumsForEveryWindow) {
  Random random(1);
  for (int n = 0; n <= 35; ++n) {
    const Table table = random_table(&random);
    std::vector<Cell> cells;
    for (int i = 0; i < 600; ++i) cells.push_back({random.integer(-180, 180), random.integer(-150, 150)});
    const int nx = n;
    const int ny = random.integer(0, 6);
    Slice slice(nx, ny);
    slice.score(table.view(), cells);
    for (int iy = -ny; iy <= ny; ++iy) {
      for (int ix = -nx; ix <= nx; ++ix) ASSERT_EQ(slice.sum(ix, iy), plain_sum(table, cells, ix, iy)) << nx;
    }
  }
}

TEST(Slice, LargestSumsDoNotOverflow) {
  Table table;
  table.draw({{0.0, 0.0}}, {{0}}, {});
  const std::vector<Cell> cells(2000, Cell{0, 0});
  Slice slice(1, 1);
  slice.score(table.view(), cells);
  EXPECT_EQ(slice.sum(0, 0), 2000U * 255U);
}

TEST(Pyramid, NoValueIsBelowAnyItCovers) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const Table table = random_table(&random);
    const BoundPyramid pyramid(table.view());
    for (int draw = 0; draw < 100; ++draw) {
      const int h = random.integer(1, pyramid.top());
      const TableView level = pyramid.level(h);
      const int ix = random.integer(-250, 130);
      const int iy = random.integer(-250, 130);
      const int column = ix - level.x0;
      const int row = iy - level.y0;
      const bool inside = column >= 0 && row >= 0 && column < level.width && row < level.height;
      const int bound = inside ? level.data[row * level.stride + column] : 0;
      const int last = (1 << h) - 1;
      int largest = 0;
      for (int k = 0; k < 40; ++k) {
        largest = std::max<int>(largest, table.value(ix + random.integer(0, last), iy + random.integer(0, last)));
      }
      ASSERT_GE(bound, largest) << "level " << h;
    }
  }
}

TEST(Pyramid, IsTightWhereItIsSmall) {
  Random random(3);
  const Table table = random_table(&random);
  const BoundPyramid pyramid(table.view());
  const TableView level = pyramid.level(2);
  for (int row = 0; row < level.height; ++row) {
    for (int column = 0; column < level.width; ++column) {
      int largest = 0;
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
          largest = std::max<int>(largest, table.value(level.x0 + column + i, level.y0 + row + j));
        }
      }
      ASSERT_EQ(level.data[row * level.stride + column], largest);
    }
  }
}

void expect_same(const Search& search) {
  const auto all = search_all(search);
  const BoundedResult two_level = search_two_level(search, 1 << 20);
  EXPECT_FALSE(two_level.is_cut_short);
  for (const auto& bounded : {search_bounded(search), two_level.best}) {
    ASSERT_EQ(all.has_value(), bounded.has_value());
    if (!all) return;
    EXPECT_EQ(all->value, bounded->value);
    EXPECT_EQ(all->sum, bounded->sum);
    EXPECT_EQ(all->it, bounded->it);
    EXPECT_EQ(all->ix, bounded->ix);
    EXPECT_EQ(all->iy, bounded->iy);
  }
}

Prior random_prior(Random* random, const Pose& near) {
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = random->real(-0.3, 0.3);
  return {{near.x + random->real(-0.2, 0.2), near.y + random->real(-0.2, 0.2), near.theta + random->real(-0.2, 0.2)},
          root * root.transpose() + 1e-3 * Eigen::Matrix3d::Identity()};
}

Search random_search(Random* random, const Table& table, const Points& body, const Pose& guess) {
  const Lattice lattice{guess,
                        table.params().cell,
                        random->real(0.005, 0.05),
                        random->integer(0, 30),
                        random->integer(0, 30),
                        random->integer(0, 4)};
  const Prior prior = random_prior(random, guess);
  const bool with_prior = random->integer(0, 1) == 1;
  Search search{table, body, lattice, Objective(random->real(1.0, 500.0), body.size(), with_prior ? &prior : nullptr),
                std::nullopt};
  if (random->integer(0, 3) == 0) {
    search.exclusion = Exclusion{{random->integer(-2, 2), random->integer(-9, 9), random->integer(-9, 9), 0, 0.0},
                                 random->integer(0, 8),
                                 random->integer(0, 8),
                                 random->integer(0, 2)};
    search.least_sum = static_cast<std::uint32_t>(random->integer(0, 100)) * static_cast<std::uint32_t>(body.size());
  }
  return search;
}

TEST(BranchAndBound, FindsWhatTryingAllFinds) {
  Random random(4);
  for (int trial = 0; trial < 600; ++trial) {
    const Table table = random_table(&random);
    Points body;
    const int n = random.integer(1, 40);
    for (int i = 0; i < n; ++i) body.push_back({random.real(-2.0, 2.0), random.real(-2.0, 2.0)});
    const Pose guess{random.real(-2.0, 2.0), random.real(-2.0, 2.0), random.real(-3.0, 3.0)};
    expect_same(random_search(&random, table, body, guess));
  }
}

TEST(BranchAndBound, FindsWhatTryingAllFindsInRoomsAndCorridors) {
  Random random(5);
  for (int trial = 0; trial < 400; ++trial) {
    const test::Scene scene = trial % 2 == 0 ? test::room(random.real(-3.0, 3.0)) : test::corridor();
    const test::Sensor sensor{random.integer(30, 90), random.real(1.0, 3.1), 6.0, 0.01};
    const Pose truth{random.real(-0.3, 0.3), random.real(-0.2, 0.6), random.real(-3.0, 3.0)};
    const Points drawn = test::scan(scene, truth, sensor, random.engine());
    const Points body = test::scan(scene, truth, sensor, random.engine());
    if (body.empty()) continue;
    Table table;
    table.draw(transform(truth, drawn), extract_contours(drawn, {}), truth);
    const Pose guess = truth * Pose{random.real(-0.3, 0.3), random.real(-0.3, 0.3), random.real(-0.1, 0.1)};
    expect_same(random_search(&random, table, body, guess));
  }
}

TEST(TwoLevel, SaysWhenItsWorkWasCutShort) {
  std::mt19937 random(6);
  const Points body = test::scan(test::corridor(), {}, {181, test::kPi, 8.0, 0.01}, random);
  Table table;
  table.draw(body, extract_contours(body, ContourParams::urg()), {});
  const Search search{table, body, {{}, 0.02, 0.01, 60, 60, 20}, Objective(1.0, body.size(), nullptr), std::nullopt};
  const BoundedResult little = search_two_level(search, 2);
  EXPECT_TRUE(little.is_cut_short);
  const BoundedResult enough = search_two_level(search, 1 << 20);
  EXPECT_FALSE(enough.is_cut_short);
  ASSERT_TRUE(little.best && enough.best);
  EXPECT_LE(little.best->value, enough.best->value);
}

TEST(Search, EqualScoresGoToTheNearestOfTheGuess) {
  Table table;
  table.draw({{-5.0, 1.0}, {5.0, 1.0}}, {{0, 1}}, {});
  const Points body = {{0.0, 1.0}, {0.1, 1.0}, {0.2, 1.0}};
  const Search search{table, body, {{}, 0.02, 0.01, 10, 10, 0}, Objective(1.0, body.size(), nullptr), std::nullopt};
  for (const auto& best : {search_all(search), search_bounded(search)}) {
    ASSERT_TRUE(best);
    EXPECT_EQ(best->ix, 0);
    EXPECT_EQ(best->iy, 0);
    EXPECT_EQ(best->sum, 3U * 255U);
  }
}

}  // namespace
}  // namespace frsm
