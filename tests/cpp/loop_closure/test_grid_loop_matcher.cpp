// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// branch_and_bound_matcher: where a node stands in the submap of another.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "mapping_fixtures.hpp"
#include "oort/loop_closure/grid_loop_matcher.hpp"
#include "oort/loop_closure/loop_closure_builder.hpp"

namespace oort {
namespace {

const Pose2 kError{0.6, -0.4, 0.2};  // of the query in the graph, along its own axes

/// A chain of 15 nodes, and after it, as a segment of its own, a query near node 7 that is misplaced in the graph.
class GridLoopTest : public ::testing::Test {
 protected:
  GridLoopTest() {
    const std::vector<Pose2> truth = testing::laps(0.5);
    std::vector<Pose2> places;
    for (std::size_t k = 0; k < 15; ++k) places.push_back(truth[5 * k]);
    testing::append_chain(testing::make_room(), places, testing::kAllRound, map, segments);
    testing::append_chain(testing::make_room(), {places[7] * offset}, testing::kAllRound, map, segments);
    map.graph.nodes[15].pose = map.graph.nodes[15].pose * kError;
    parameters.loop_closure_graph_builder.scanmatcher = "branch_and_bound_matcher";
  }

  LoopMatcher::Found find(const SearchWindow& window) {
    return GridLoopMatcher(parameters, scale).find(map, segments, 15, 7, window);
  }

  const Pose2 offset{0.05, 0.03, 1.0};
  Map map;
  TrajectorySegments segments;
  Parameters parameters;
  BranchAndBoundMatcherParameters& p = parameters.loop_closure_graph_builder.branch_and_bound_matcher;
  LoopScale scale;
};

TEST_F(GridLoopTest, FindsTheQueryWhereItIs) {
  const LoopMatcher::Found found = find({1.0, 0.4, {}});
  ASSERT_EQ(found.rejection, Rejection::kNone);
  EXPECT_LT(between(offset, found.T_candidate_query).translation().norm(), 0.05) << "a cell";
  EXPECT_NEAR(found.T_candidate_query.theta, offset.theta, 0.01);
  EXPECT_GT(found.inlier_ratio, 0.7);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(found.covariance).eigenvalues().minCoeff(), 0.0);
  scale.sigma_xy = 0.5;
  EXPECT_NEAR(find({1.0, 0.4, {}}).covariance(0, 0), found.covariance(0, 0) + 0.25, 1e-9);
}

TEST_F(GridLoopTest, DrawsTheSubmapInOnePiece) {
  GridLoopMatcher matcher(parameters, scale);
  EXPECT_TRUE(matcher.draw(map, segments, 7));
  EXPECT_FALSE(matcher.draw(map, segments, 7));
  EXPECT_EQ(matcher.find(map, segments, 15, 7, {1.0, 0.4, {}}).T_candidate_query.x,
            find({1.0, 0.4, {}}).T_candidate_query.x);
}

TEST_F(GridLoopTest, LeavesOutWhatIsFartherThanItsReach) {
  const auto nodes = segments.neighborhood(7, 15);
  const auto cells = [&](double reach) {
    const GridLimits limits = draw_grid(map, segments, 7, nodes, p.probability_grid, reach).limits();
    return limits.width * limits.height;
  };
  EXPECT_LT(cells(1.0), cells(100.0));
  scale.reach = 0.0;
  EXPECT_EQ(find({1.0, 0.4, {}}).rejection, Rejection::kGridEmptyScan);
}

TEST_F(GridLoopTest, RefusesWithAReason) {
  EXPECT_EQ(find({0.1, 0.05, {}}).rejection, Rejection::kLowScore) << "it is not within the window";
  p.min_score = 0.89;
  EXPECT_EQ(find({1.0, 0.4, {}}).rejection, Rejection::kLowScore);
  p.submap_min_neighborhood_size = 15;
  EXPECT_EQ(find({1.0, 0.4, {}}).rejection, Rejection::kSmallSubmap);
}

TEST_F(GridLoopTest, TheBuilderUsesItWithItsWindowAndFilter) {
  LoopClosureGraphBuilderParameters& loop = parameters.loop_closure_graph_builder;
  loop.candidate_search.knearest_neighbors = 1;
  loop.candidate_search.candidate_stride = 1;
  p.search_window_sigmas = 0.0;
  ClosureCounts counts;
  const auto closures = [&] {
    counts = {};
    LoopClosureBuilder builder(parameters);
    builder.look(map, segments, 15);
    ClosureLog log;
    return builder.work_off(map, segments, counts, log);
  };
  EXPECT_EQ(closures().size(), 1u);
  p.match_filter.match_max_dist = p.match_filter.match_max_dist_high = 0.3;
  EXPECT_TRUE(closures().empty());
  EXPECT_EQ(counts.rejected[Rejection::kDistance], 1u);
  // Farther than match_max_dist the higher thresholds count, by the direction that the query looks in.
  MatchFilterParameters& filter = p.match_filter;
  filter.match_max_dist_high = 2.0;
  filter.match_hitpct_threshold_high = filter.match_hitpct_threshold_high_opposite_dir = 0.0;
  EXPECT_EQ(closures().size(), 1u);
  for (const bool opposite : {false, true}) {
    filter.opposite_dir_threshold = opposite ? 0.0 : 3.14;
    filter.match_hitpct_threshold_high = opposite ? 0.0 : 1.0;
    filter.match_hitpct_threshold_high_opposite_dir = opposite ? 1.0 : 0.0;
    EXPECT_TRUE(closures().empty());
    EXPECT_EQ(counts.rejected[Rejection::kHits], 1u);
  }
  // And nearer the others.
  filter.match_max_dist = 2.0;
  filter.match_hitpct_threshold_high = 1.0;
  for (const bool opposite : {false, true}) {
    filter.opposite_dir_threshold = opposite ? 0.0 : 3.14;
    filter.match_hitpct_threshold = opposite ? 0.0 : 1.0;
    filter.match_hitpct_threshold_opposite_dir = opposite ? 1.0 : 0.0;
    EXPECT_TRUE(closures().empty());
    EXPECT_EQ(counts.rejected[Rejection::kHits], 1u);
  }
  filter.match_hitpct_threshold_opposite_dir = 0.0;
  EXPECT_EQ(closures().size(), 1u);
  p.fast_correlative_scan_matcher.linear_search_window = 0.1;
  EXPECT_TRUE(closures().empty());
  EXPECT_EQ(counts.rejected[Rejection::kLowScore], 1u);
}

}  // namespace
}  // namespace oort
