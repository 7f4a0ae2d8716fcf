// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>

#include "frsm/contours.hpp"
#include "scene.hpp"

namespace frsm {
namespace {

Points line(int n, double spacing, Point start = {2.0, -1.0}) {
  Points points;
  for (int i = 0; i < n; ++i) points.push_back({start.x, start.y + i * spacing});
  return points;
}

TEST(Contours, StraightWallIsOneChain) {
  for (const ContourParams& params : {ContourParams::utm(), ContourParams::urg(), ContourParams::sick()}) {
    const auto contours = extract_contours(line(50, 0.05), params);
    ASSERT_EQ(contours.size(), 1U);
    EXPECT_EQ(contours[0].size(), 50U);
  }
}

TEST(Contours, StepOfHalfAMetreSplitsWalls) {
  Points points = line(20, 0.05);
  for (const Point& p : line(20, 0.05, {2.5, 0.0})) points.push_back(p);
  EXPECT_EQ(extract_contours(points, ContourParams::sick()).size(), 2U);
}

TEST(Contours, EvenSpacing) {
  // 0.45 m from the start: no short link beside it to justify the gap. 0.3 m: always allowed.
  EXPECT_EQ(extract_contours(line(12, 0.45), ContourParams::sick()).size(), 12U);
  EXPECT_EQ(extract_contours(line(12, 0.3), ContourParams::sick()).size(), 1U);
}

TEST(Contours, WideGapIsBridgedWhereTheSpacingGrowsTowardsIt) {
  const auto chains = [](const std::vector<double>& gaps) {
    Points points{{1.0, 1.0}};
    for (const double gap : gaps) points.push_back({points.back().x + gap, 1.0});
    return extract_contours(points, ContourParams::sick()).size();
  };
  EXPECT_EQ(chains({0.1, 0.2, 0.3, 0.45, 0.3, 0.2, 0.1}), 1U);
  EXPECT_EQ(chains({0.1, 0.1, 0.1, 0.45, 0.1, 0.1, 0.1}), 2U);
  EXPECT_EQ(chains({0.15, 0.2, 0.3, 0.45, 0.7}), 1U);
  EXPECT_EQ(chains({0.15, 0.2, 0.3, 0.6}), 2U);
}

TEST(Contours, OutlierStaysAloneAndLeavesTheWallWhole) {
  Points points = line(30, 0.05);
  points[14] = {1.0, points[14].y};
  const auto contours = extract_contours(points, ContourParams::sick());
  ASSERT_EQ(contours.size(), 2U);
  EXPECT_EQ(contours[0].size(), 29U);
  EXPECT_EQ(contours[1], Contour{14});
}

TEST(Contours, FarWallOfCoarseBeamsIsOneChain) {
  ContourParams params = ContourParams::urg();
  params.max_beam_step = 0.02;
  std::mt19937 random(3);
  const Points wall = test::scan({{{20.0, -8.0}, {20.0, 8.0}}}, {}, {181, test::kPi, 30.0, 0.02}, random);
  EXPECT_EQ(extract_contours(wall, ContourParams::urg()).size(), wall.size());  // 0.35 m apart
  EXPECT_EQ(extract_contours(wall, params).size(), 1U);
  // A step from one wall to another stays open, and so do walls that too coarse beams see.
  const test::Scene step = {{{10.0, -8.0}, {10.0, 0.0}}, {{20.0, 0.0}, {20.0, 8.0}}};
  EXPECT_EQ(extract_contours(test::scan(step, {}, {181, test::kPi, 30.0, 0.0}, random), params).size(), 2U);
  const Points coarse = test::scan(step, {}, {61, test::kPi, 30.0, 0.0}, random);
  EXPECT_EQ(extract_contours(coarse, params).size(), coarse.size());
}

TEST(Contours, ACoarseLasersOwnStepLinksAFarWall) {
  ContourParams params = ContourParams::urg();
  params.max_beam_step = 0.02;
  std::mt19937 random(3);
  const test::Scene wall = {{{20.0, -8.0}, {20.0, 8.0}}};
  const Points coarse = test::scan(wall, {}, {61, test::kPi, 30.0, 0.02}, random);  // 3 degrees, 1 m apart
  EXPECT_EQ(extract_contours(coarse, params).size(), coarse.size());
  params.widest_beam_step = 0.08;
  EXPECT_EQ(extract_contours(coarse, params).size(), 1U);
  // Of a finer laser a gap stays one, and so do beams that are farther apart than the widest step.
  Points fine = test::scan(wall, {}, {181, test::kPi, 30.0, 0.02}, random);
  fine.erase(fine.begin() + static_cast<std::ptrdiff_t>(fine.size() / 2));
  EXPECT_EQ(extract_contours(fine, params).size(), 2U);
  const Points coarsest = test::scan(wall, {}, {31, test::kPi, 30.0, 0.02}, random);
  EXPECT_EQ(extract_contours(coarsest, params).size(), coarsest.size());
}

TEST(Contours, AWallSeenAtAGrazingAngleIsOneChain) {
  ContourParams params = ContourParams::urg();
  params.widest_beam_step = 0.08;
  ContourParams steep_only = params;
  steep_only.max_straight_slope = params.max_beam_slope;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    const test::Sensor coarse{181, 1.5 * test::kPi, 20.0, 0.015};  // 1.5 degrees: up to 2.6 m apart
    const Points wall = test::scan({{{-30.0, -4.0}, {30.0, -4.0}}}, {}, coarse, random);
    EXPECT_LE(extract_contours(wall, params).size(), 3U);
    EXPECT_GT(extract_contours(wall, steep_only).size(), 10U);
    // A row of pillars is none, though they stand as evenly as beams hit walls.
    test::Scene pillars;
    for (int k = 0; k < 12; ++k) test::add_box(&pillars, {2.0 + 1.5 * k, -4.0, 0.0}, 0.2, 0.2);
    EXPECT_GE(extract_contours(test::scan(pillars, {}, coarse, random), params).size(), 8U);
  }
}

TEST(Contours, EmptyAndSinglePoint) {
  EXPECT_TRUE(extract_contours({}, ContourParams::sick()).empty());
  const auto contours = extract_contours({{1.0, 1.0}}, ContourParams::sick());
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_EQ(contours[0], Contour{0});
}

TEST(Contours, EveryPointIsInOneChainAndIndicesIncrease) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-2.0, 2.0);
  for (int trial = 0; trial < 100; ++trial) {
    Points points;
    for (int i = 0; i < 120; ++i) points.push_back({coordinate(random), coordinate(random)});
    std::vector<int> seen(points.size(), 0);
    for (const Contour& contour : extract_contours(points, ContourParams::utm())) {
      EXPECT_TRUE(std::is_sorted(contour.begin(), contour.end()));
      for (const std::size_t i : contour) ++seen[i];
    }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  }
}

TEST(Contours, MirroredScanGivesMirroredChains) {
  std::mt19937 random(4);
  const Points points = test::scan(test::room(0.2), {0.1, 0.4, 0.3}, {181, test::kPi, 8.0, 0.01}, random);
  Points mirrored(points.rbegin(), points.rend());
  for (Point& p : mirrored) p.y = -p.y;
  EXPECT_EQ(extract_contours(points, ContourParams::sick()).size(),
            extract_contours(mirrored, ContourParams::sick()).size());
}

TEST(Contours, NamesTheParameterThatMakesNoSense) {
  ContourParams params;
  params.search_range = 0;
  EXPECT_THROW(extract_contours({}, params), std::invalid_argument);
}

}  // namespace
}  // namespace frsm
