// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/grid/voxel_filter.hpp"

namespace oort {
namespace {

Points random_points(std::uint32_t seed, std::size_t count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> range(0.1, 8.0);
  std::uniform_real_distribution<double> bearing(-3.1, 3.1);
  Points points;
  while (points.size() < count) {
    const double r = range(random);
    const double b = bearing(random);
    points.push_back({r * std::cos(b), r * std::sin(b)});
  }
  return points;
}

/// Whether all of `some` are among `all`, in the same order.
bool is_subsequence(const Points& some, const Points& all) {
  auto next = all.begin();
  for (const Eigen::Vector2d& point : some) {
    next = std::find(next, all.end(), point);
    if (next == all.end()) return false;
    ++next;
  }
  return true;
}

TEST(VoxelFilter, KeepsTheFirstPointOfEachVoxel) {
  const Points points = random_points(1, 500);
  const Points kept = voxel_filter(points, 0.7);
  const auto voxel = [](const Eigen::Vector2d& p) {
    return std::make_pair(std::floor(p.x() / 0.7), std::floor(p.y() / 0.7));
  };
  std::set<std::pair<double, double>> seen;
  Points expected;
  for (const Eigen::Vector2d& point : points) {
    if (seen.insert(voxel(point)).second) expected.push_back(point);
  }
  EXPECT_EQ(kept, expected);
  EXPECT_LT(kept.size(), points.size());
}

TEST(VoxelFilter, RefusesLengthsThatAreNone) {
  EXPECT_THROW(voxel_filter({}, 0.0), ParameterError);
  EXPECT_THROW(voxel_filter({}, -1.0), ParameterError);
  EXPECT_THROW(voxel_filter({}, std::nan("")), ParameterError);
  EXPECT_TRUE(voxel_filter({}, 1.0).empty());
}

TEST(AdaptiveVoxelFilter, KeepsWhatItPromises) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const Points points = random_points(seed, 50 + 17 * seed);
    for (const int least : {1, 60, 150, 400}) {
      const AdaptiveVoxelFilterParameters parameters{0.9, least, 6.0};
      const auto in_range = static_cast<std::size_t>(std::count_if(
          points.begin(), points.end(), [](const Eigen::Vector2d& point) { return point.norm() <= 6.0; }));
      const Points kept = adaptive_voxel_filter(points, parameters);
      EXPECT_TRUE(is_subsequence(kept, points));
      EXPECT_TRUE(std::all_of(kept.begin(), kept.end(), [](const auto& point) { return point.norm() <= 6.0; }));
      EXPECT_GE(kept.size(), std::min(in_range, static_cast<std::size_t>(least)));
      EXPECT_GE(kept.size(), std::min(in_range, voxel_filter(kept, 0.9).size()));
    }
  }
}

TEST(AdaptiveVoxelFilter, ThinsNoMoreThanItMust) {
  const Points points = random_points(3, 2000);
  EXPECT_EQ(adaptive_voxel_filter(points, {0.9, 1, 50.0}), voxel_filter(points, 0.9)) << "the longest is enough";
  const Points kept = adaptive_voxel_filter(points, {4.0, 150, 50.0});
  EXPECT_GE(kept.size(), 150u);
  EXPECT_LT(kept.size(), 220u) << "squares a tenth longer would leave too few";
  EXPECT_EQ(adaptive_voxel_filter(points, {0.9, 2000, 50.0}), points) << "not too many: none is dropped";
  EXPECT_EQ(adaptive_voxel_filter(points, {0.0, 150, 50.0}), points) << "no length: no thinning";
}

TEST(AdaptiveVoxelFilter, KeepsAllWherePointsLieTooCloseToBeThinned) {
  Points points;
  for (int k = 0; k < 300; ++k) points.push_back({1.0 + 1e-6 * k, 1.0});
  EXPECT_EQ(adaptive_voxel_filter(points, {0.9, 150, 50.0}), points);
}

}  // namespace
}  // namespace oort
