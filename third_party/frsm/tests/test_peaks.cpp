// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Peaks of a wide search, against trying all poses.
#include "frsm/peaks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "scene.hpp"
#include "search.hpp"

namespace frsm {
namespace {

constexpr double kCell = 0.05, kStep = 0.05;

Table drawn(const test::Scene& scene, const std::vector<Pose>& from) {
  TableParams params;
  params.cell = kCell;
  params.sigma = 0.08;
  Table table(params);
  std::mt19937 random(1);
  for (const Pose& pose : from) {
    const Points points = transform(pose, test::scan(scene, pose, {}, random));
    table.draw(points, extract_contours(points, ContourParams::urg()), pose);
  }
  return table;
}

PeakParams params() {
  PeakParams p;
  p.theta_step = kStep;
  p.floor = 0.1;
  p.ratio = 0.5;
  return p;
}

TEST(Peaks, TheFirstTwoAreThoseOfTryingAllPoses) {
  const Table table = drawn(test::room(0.2), {{0.0, 0.3, 0.4}, {1.0, -0.5, 2.5}});
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-0.8, 0.8), turn(-3.0, 3.0);
  for (int i = 0; i < 10; ++i) {
    const Pose pose{place(random), place(random), turn(random)};
    const Points body = test::scan(test::room(0.2), pose, {}, random);
    const Pose middle{0.1, -0.1, 0.0};
    const Window window{1.5, 1.2, 1.0};
    const Peaks found = find_peaks(table, body, middle, window, params());
    ASSERT_GE(found.peaks.size(), 1U);

    const Lattice lattice{middle, kCell, kStep, 30, 24, 20};
    const Search all{table, body, lattice, Objective(1.0, body.size(), nullptr), std::nullopt};
    const Candidate best = *search_all(all);
    EXPECT_DOUBLE_EQ(found.peaks[0].score, best.sum / (255.0 * static_cast<double>(body.size())));
    if (found.peaks.size() < 2) continue;
    // Of poses that score the same either may have been taken: leave out what the finder took.
    Candidate taken;
    taken.ix = static_cast<int>(std::lround((found.peaks[0].pose.x - middle.x) / kCell));
    taken.iy = static_cast<int>(std::lround((found.peaks[0].pose.y - middle.y) / kCell));
    taken.it = static_cast<int>(std::lround(wrap(found.peaks[0].pose.theta - middle.theta) / kStep));
    const Search rest{table, body, lattice, all.objective, Exclusion{taken, 6, 6, 6}, all.least_sum};
    EXPECT_DOUBLE_EQ(found.peaks[1].score, search_all(rest)->sum / (255.0 * static_cast<double>(body.size())));
  }
}

TEST(Peaks, FallInScoreAndAreApart) {
  const Table table = drawn(test::room(), {{0.0, 0.3, 0.4}, {1.0, -0.5, 2.5}});
  std::mt19937 random(3);
  const Points body = test::scan(test::room(), {0.5, -0.4, 1.0}, {}, random);
  const Peaks found = find_peaks(table, body, {0.0, 0.0, 0.0}, {4.0, 4.0, test::kPi}, params());
  ASSERT_GE(found.peaks.size(), 2U);
  EXPECT_NEAR(distance(found.peaks[0].pose, {0.5, -0.4, 1.0}), 0.0, 1.5 * kCell);
  for (std::size_t i = 1; i < found.peaks.size(); ++i) {
    EXPECT_LE(found.peaks[i].score, found.peaks[i - 1].score);
    EXPECT_GE(found.peaks[i].score, 0.5 * found.peaks[0].score - 1e-9);
    for (std::size_t j = 0; j < i; ++j) {
      const Pose d = between(found.peaks[j].pose, found.peaks[i].pose);
      EXPECT_TRUE(std::hypot(d.x, d.y) > 0.3 || std::abs(d.theta) > 0.3) << i << " and " << j;
    }
  }
}

TEST(Peaks, SayWhenTheyAreNotAll) {
  const Table table = drawn(test::corridor(), {{0.0, 0.0, 0.0}});
  std::mt19937 random(4);
  const Points body = test::scan(test::corridor(), {0.0, 0.1, 0.0}, {}, random);
  PeakParams few = params();
  few.max_peaks = 2;
  const Peaks found = find_peaks(table, body, {}, {4.0, 1.0, test::kPi}, few);
  EXPECT_EQ(found.peaks.size(), 2U);
  EXPECT_FALSE(found.complete);
  few = params();
  few.max_expansions = 5;
  EXPECT_FALSE(find_peaks(table, body, {}, {4.0, 1.0, test::kPi}, few).complete);
}

TEST(Peaks, NothingIsFoundOfNothing) {
  const Table table = drawn(test::room(), {{0.0, 0.0, 0.0}});
  EXPECT_TRUE(find_peaks(table, {}, {}, {1.0, 1.0, 1.0}, params()).peaks.empty());
  EXPECT_TRUE(find_peaks(Table(), {{1.0, 0.0}}, {}, {1.0, 1.0, 1.0}, params()).peaks.empty());
  EXPECT_THROW(find_peaks(table, {{1.0, 0.0}}, {NAN, 0.0, 0.0}, {1.0, 1.0, 1.0}, params()), std::invalid_argument);
  EXPECT_THROW(find_peaks(table, {{1.0, 0.0}}, {}, {-1.0, 1.0, 1.0}, params()), std::invalid_argument);
}

}  // namespace
}  // namespace frsm
