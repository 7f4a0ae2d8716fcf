// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "frsm/history.hpp"
#include "frsm/table.hpp"
#include "scene.hpp"

namespace frsm {
namespace {

TableParams with_cell(double cell) {
  TableParams params;
  params.cell = cell;
  return params;
}

Table dot(const TableParams& params, const Point& at = {0.0, 0.0}) {
  Table table(params);
  table.draw({at}, {{0}}, {});
  return table;
}

std::vector<std::uint8_t> bytes(const Table& table, int reach = 300) {
  std::vector<std::uint8_t> values;
  for (int iy = -reach; iy <= reach; ++iy) {
    for (int ix = -reach; ix <= reach; ++ix) values.push_back(table.value(ix, iy));
  }
  return values;
}

void draw_scan(Table* table, const Pose& pose, unsigned seed) {
  std::mt19937 random(seed);
  const Points body = test::scan(test::room(0.3), pose, {181, test::kPi, 8.0, 0.01}, random);
  table->draw(transform(pose, body), extract_contours(body, {}), pose);
}

TEST(Table, RoomThatWasMadeChangesNothing) {
  const Points world{{0.0, 0.0}, {1.0, 0.3}, {4.0, -2.5}};
  Table drawn(with_cell(0.02)), reserved(with_cell(0.02));
  reserved.reserve({0.0, -2.5}, {4.0, 0.3});
  EXPECT_TRUE(reserved.empty());
  for (const Point& point : world) {
    drawn.draw({point}, {{0}}, {});
    reserved.draw({point}, {{0}}, {});
  }
  EXPECT_EQ(drawn.view().width, reserved.view().width);
  EXPECT_EQ(drawn.view().height, reserved.view().height);
  EXPECT_EQ(bytes(drawn), bytes(reserved));
  EXPECT_THROW(reserved.reserve({0.0, 0.0}, {1e4, 1e4}), std::length_error);
  EXPECT_THROW(reserved.reserve({1.0, 0.0}, {0.0, 0.0}), std::invalid_argument);
}

TEST(Table, TellsWhatBoundsCostOnceTheyAreBuilt) {
  const Table table = dot(with_cell(0.02));
  std::uint64_t told = 0;
  const OnLookups on_lookups = [&told](std::uint64_t lookups) { told += lookups; };
  table.bounds(on_lookups);
  const std::uint64_t once = told;
  EXPECT_GT(once, 0u);
  table.bounds(on_lookups);
  EXPECT_EQ(told, once);
  table.blocks(on_lookups);
  EXPECT_GT(told, once);
}

TEST(Kernel, HasTheDocumentedValues) {
  const std::vector<std::pair<double, std::vector<int>>> expected = {{0.01, {255, 220, 190, 164, 141, 122, 105, 90}},
                                                                     {0.02, {255, 190, 141, 105, 78, 58, 43, 32, 0}},
                                                                     {0.05, {255, 122, 58, 28, 0}}};
  for (const auto& [cell, values] : expected) {
    const Table table = dot(with_cell(cell));
    for (int i = 0; i < static_cast<int>(values.size()); ++i) {
      EXPECT_EQ(table.value(i, 0), values[i]) << cell << " " << i;
      EXPECT_EQ(table.value(-i, 0), values[i]);
      EXPECT_EQ(table.value(0, i), values[i]);
      EXPECT_EQ(table.value(0, -i), values[i]);
    }
  }
  EXPECT_EQ(dot(with_cell(0.01)).value(14, 0), 32);
  EXPECT_EQ(dot(with_cell(0.01)).value(15, 0), 0);
}

TEST(Kernel, IsRoundAndFallsWithDistance) {
  const Table table = dot(with_cell(0.02));
  EXPECT_GE(table.value(3, 1), 100);  // a hit, as in the original
  EXPECT_EQ(table.value(3, 4), table.value(5, 0));
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) EXPECT_GE(table.value(i, j), table.value(i + 1, j));
  }
}

TEST(Draw, EverySlopeIsTrueToDistance) {
  const TableParams params;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  for (int trial = 0; trial < 50; ++trial) {
    const Point a{coordinate(random), coordinate(random)};
    const Point b = trial % 5 == 0 ? Point{a.x, coordinate(random)}
                                   : (trial % 5 == 1 ? Point{coordinate(random), a.y}
                                                     : Point{coordinate(random), coordinate(random)});
    Table table(params);
    table.draw({a, b}, {{0, 1}}, {});
    const double length2 = std::pow(b.x - a.x, 2) + std::pow(b.y - a.y, 2);
    for (int iy = -60; iy <= 60; ++iy) {
      for (int ix = -60; ix <= 60; ++ix) {
        const double x = table.coordinate(ix);
        const double y = table.coordinate(iy);
        const double t = std::clamp(((x - a.x) * (b.x - a.x) + (y - a.y) * (b.y - a.y)) / length2, 0.0, 1.0);
        const double d = std::hypot(x - a.x - t * (b.x - a.x), y - a.y - t * (b.y - a.y));
        if (std::abs(d - 7 * params.cell) < 1e-4) continue;  // on the kernel's rim
        const double expected = d < 7 * params.cell ? 255.0 * std::exp(-d / params.sigma) : 0.0;
        ASSERT_NEAR(table.value(ix, iy), expected, 255.0 * 0.09 / 3.375) << d;
        if (d > params.cell) {
          ASSERT_NEAR(table.value(ix, iy), expected, 0.9) << d;
        }
      }
    }
  }
}

TEST(Draw, AgainChangesNothing) {
  Table once;
  draw_scan(&once, {0.1, 0.2, 0.3}, 1);
  Table twice = once;
  draw_scan(&twice, {0.1, 0.2, 0.3}, 1);
  EXPECT_EQ(bytes(once), bytes(twice));
}

TEST(Draw, OrderDoesNotMatter) {
  const std::vector<Pose> poses = {{0.1, 0.2, 0.3}, {-1.0, 0.5, 2.0}, {1.2, -0.7, -1.0}};
  Table forward, backward;
  for (unsigned i = 0; i < 3; ++i) draw_scan(&forward, poses[i], i);
  for (unsigned i = 3; i-- > 0;) draw_scan(&backward, poses[i], i);
  EXPECT_EQ(bytes(forward), bytes(backward));
}

TEST(Draw, KeepsOffWhatIsFarOrNotANumber) {
  TableParams params;
  params.radius = 2.0;
  Table table(params);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  table.draw({{3.0, 0.0}, {kNan, 0.0}}, {{0, 1}}, {});
  EXPECT_TRUE(table.empty());
  // The line to a point out of reach is not drawn; the point before it still is.
  table.draw({{1.0, 0.0}, {3.0, 0.0}, {1.0, 1.0}}, {{0, 1, 2}}, {});
  EXPECT_EQ(table.value(50, 0), 255);
  EXPECT_EQ(table.value(75, 0), 0);
  EXPECT_EQ(table.value(50, 50), 255);
  EXPECT_EQ(table.value(50, 25), 0);
}

TEST(Draw, RefusesAnAbsurdArea) {
  Table table = dot({});
  EXPECT_THROW(table.draw({{5e5, 5e5}}, {{0}}, {5e5, 5e5, 0.0}), std::length_error);
  EXPECT_EQ(table.value(0, 0), 255);
}

TEST(Table, ReadsZeroOutsideAndAfterClear) {
  Table table = dot({});
  EXPECT_EQ(table.value(1000000, -1000000), 0);
  EXPECT_EQ(table.index(0.029), 1);
  EXPECT_EQ(table.index(-0.029), -1);
  EXPECT_EQ(table.index(-0.031), -2);
  EXPECT_GT(table.bytes(), 0U);
  table.clear();
  EXPECT_TRUE(table.empty());
  EXPECT_EQ(table.value(0, 0), 0);
  double dx, dy;
  EXPECT_EQ(table.interpolate(0.0, 0.0, &dx, &dy), 0.0);
}

TEST(Table, GradientIsThatOfTheInterpolatedValue) {
  Table table;
  draw_scan(&table, {0.1, 0.2, 0.3}, 1);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> coordinate(-4.0, 4.0);
  double dx, dy, unused;
  for (int trial = 0; trial < 2000; ++trial) {
    const double x = coordinate(random);
    const double y = coordinate(random);
    table.interpolate(x, y, &dx, &dy);
    constexpr double kStep = 1e-6;
    const auto value = [&](double u, double v) { return table.interpolate(u, v, &unused, &unused); };
    EXPECT_NEAR(dx, (value(x + kStep, y) - value(x - kStep, y)) / (2.0 * kStep), 2e-2);
    EXPECT_NEAR(dy, (value(x, y + kStep) - value(x, y - kStep)) / (2.0 * kStep), 2e-2);
  }
}

TEST(Table, PeakLiesOnTheLineWhereverItFallsBetweenCells) {
  for (double offset = 0.0; offset < 0.02; offset += 0.001) {
    Table table;
    table.draw({{-1.0, 1.0 + offset}, {1.0, 1.0 + offset}}, {{0, 1}}, {});
    double best = 0.0, at = 0.0, dx, dy;
    for (double y = 0.97; y < 1.05; y += 1e-4) {
      const double value = table.interpolate(0.0, y, &dx, &dy);
      if (value > best) {
        best = value;
        at = y;
      }
    }
    EXPECT_NEAR(at, 1.0 + offset, 0.0025) << offset;
  }
}

TEST(Table, NamesTheParameterThatMakesNoSense) {
  for (const double cell : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(Table{with_cell(cell)}, std::invalid_argument);
  }
  TableParams params;
  params.min_value = 0;
  EXPECT_THROW(Table{params}, std::invalid_argument);
}

// One dot per scan, in a row, so that each cell tells which scan drew it.
TEST(History, HoldsBetweenHalfAndAllOfTheLastScans) {
  constexpr int kMax = 8;
  History history({}, kMax);
  for (int scan = 0; scan < 5 * kMax; ++scan) {
    history.add({{scan * 0.4, 0.0}}, {{0}}, {scan * 0.4, 0.0, 0.0});
    const auto holds = [&](int i) { return history.table().value(i * 20, 0) == 255; };
    if (scan + 1 >= kMax) {
      EXPECT_GE(history.num_scans(), kMax / 2);
      EXPECT_LT(history.num_scans(), kMax);
    }
    for (int i = 0; i <= scan; ++i) EXPECT_EQ(holds(i), i > scan - history.num_scans()) << i << " of " << scan;
  }
  history.clear();
  EXPECT_TRUE(history.table().empty());
  EXPECT_EQ(history.num_scans(), 0);
}

TEST(History, OfSparseScansTwiceAsManyAreKept) {
  History history({}, 8);
  for (int scan = 0; scan < 80; ++scan) {
    history.add({{0.4 * scan, 0.0}}, {{0}}, {0.4 * scan, 0.0, 0.0}, true);
    if (scan + 1 < 16) continue;
    EXPECT_GE(history.num_scans(), 8);
    EXPECT_LT(history.num_scans(), 16);
  }
}

TEST(History, EqualsATableDrawnAfresh) {
  History history({}, 6);
  for (unsigned i = 0; i < 15; ++i) {
    const Pose pose{0.1 * i - 0.7, 0.2, 0.1 * i};
    std::mt19937 random(i);
    const Points body = test::scan(test::room(), pose, {181, test::kPi, 8.0, 0.01}, random);
    history.add(transform(pose, body), extract_contours(body, {}), pose);
  }
  Table fresh;
  for (unsigned i = 15 - history.num_scans(); i < 15; ++i) {
    const Pose pose{0.1 * i - 0.7, 0.2, 0.1 * i};
    std::mt19937 random(i);
    const Points body = test::scan(test::room(), pose, {181, test::kPi, 8.0, 0.01}, random);
    fresh.draw(transform(pose, body), extract_contours(body, {}), pose);
  }
  EXPECT_EQ(bytes(history.table()), bytes(fresh));
}

}  // namespace
}  // namespace frsm
