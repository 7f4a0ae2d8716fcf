// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Which matches close a loop. The rules are tried with one match, whose hits and
// whose distance from what the graph expects are known, and thresholds just on either side of them.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "mapping_fixtures.hpp"
#include "oort/loop_closure/loop_closure_builder.hpp"

namespace oort {
namespace {

using testing::World;

constexpr std::uint64_t kQuery = 15;
constexpr std::uint64_t kCandidate = 0;
const Pose2 kDisplacement{0.3, 0.0, 0.1};  // of the query in the graph, along its own axes
const Pose2 kOffset{0.02, 0.0, 1.0};       // of the query's true place from the candidate's

double above(double value) {
  return std::nextafter(value, std::numeric_limits<double>::infinity());
}
double below(double value) {
  return std::nextafter(value, -std::numeric_limits<double>::infinity());
}

/// A chain of 15 nodes, and as node 15 of it a query near node 0, misplaced in the graph.
class ClosureTest : public ::testing::Test {
 protected:
  ClosureTest() {
    const std::vector<Pose2> truth = testing::laps(0.5);
    std::vector<Pose2> places;
    for (std::size_t k = 0; k < 15; ++k) places.push_back(truth[5 * k]);
    testing::append_chain(world, places, testing::kAllRound, map, segments);
    testing::append_chain(world, {places[kCandidate] * kOffset}, testing::kAllRound, map, segments);
    TrajectorySegments one;
    for (std::uint64_t k = 0; k < kQuery; ++k) one.add(k == 0, true, segments.local_pose(k));
    one.add(false, true, segments.local_pose(kCandidate) * kOffset);
    segments = one;
    map.graph.nodes[kQuery].pose = map.graph.nodes[kQuery].pose * kDisplacement;
    loop.candidate_search.knearest_neighbors = 1;
    loop.candidate_search.candidate_stride = 1;
    loop.candidate_search.closest_allowed_id_threshold_small = way();
    // Everything passes, but for what a test sets.
    MatchFilterParameters& f = filter;
    f.close_node_hitpct_threshold = 0.0;
    f.match_hitpct_threshold = f.match_hitpct_threshold_opposite_dir = -1.0;
    f.match_hitpct_threshold_high = f.match_hitpct_threshold_high_opposite_dir = -1.0;
    f.close_node_max_dist = f.match_max_dist = f.match_max_dist_high = 100.0;
    f.match_max_ang_diff = f.opposite_dir_threshold = 3.15;
    set_far();
  }

  /// Of the trajectory between the two, in nodes at their usual spacing.
  int way() const { return static_cast<int>(segments.travel_between(kCandidate, kQuery)); }

  /// The two are apart by closest_allowed_id_threshold_large at least, or not.
  void set_far() { loop.candidate_search.closest_allowed_id_threshold_large = way(); }
  void set_close() { loop.candidate_search.closest_allowed_id_threshold_large = way() + 1; }

  std::vector<Closure> find_all() {
    LoopClosureBuilder builder(parameters);
    builder.look(map, segments, kQuery);
    return builder.work_off(map, segments, counts, log);
  }

  std::optional<Closure> find() {
    counts = {};
    const std::vector<Closure> closures = find_all();
    EXPECT_EQ(counts.tried, 1u);
    EXPECT_EQ(counts.accepted, closures.size());
    return closures.empty() ? std::nullopt : std::make_optional(closures.front());
  }

  Rejection verdict() {
    if (find()) return Rejection::kNone;
    const auto rejected = counts.rejected.by_text();
    EXPECT_EQ(rejected.size(), 1u);
    return rejected.front().first;
  }

  World world = testing::make_room();
  Map map;
  TrajectorySegments segments;
  Parameters parameters = testing::documented_parameters();
  LoopClosureGraphBuilderParameters& loop = parameters.loop_closure_graph_builder;
  MatchFilterParameters& filter = loop.frsm_matcher.match_filter;
  ClosureCounts counts;
  ClosureLog log;
};

TEST_F(ClosureTest, FindsTheTruePlace) {
  const std::optional<Closure> closure = find();
  ASSERT_TRUE(closure);
  EXPECT_EQ(closure->from, kQuery);
  EXPECT_EQ(closure->to, kCandidate);
  const Pose2 error = between(inverse(kOffset), closure->T_from_to);
  EXPECT_NEAR(error.x, 0.0, 0.01);
  EXPECT_NEAR(error.y, 0.0, 0.01);
  EXPECT_NEAR(error.theta, 0.0, 0.005);
  EXPECT_GT(closure->inlier_ratio, 0.9);
  EXPECT_LT(closure->covariance(0, 0), 0.01 * 0.01 * 25.0);
  EXPECT_GT(closure->covariance.determinant(), 0.0);
}

TEST_F(ClosureTest, IsTheSameEachTime) {
  const Closure first = find().value();
  const Closure again = find().value();
  EXPECT_EQ(first.T_from_to.x, again.T_from_to.x);
  EXPECT_EQ(first.T_from_to.theta, again.T_from_to.theta);
  EXPECT_EQ(first.covariance, again.covariance);
}

TEST_F(ClosureTest, FarMatchNearTheExpectedPlaceNeedsMoreThanTheHitThreshold) {
  filter.match_max_dist_high = 0.0;
  const double hits = find().value().inlier_ratio;
  filter.match_hitpct_threshold = below(hits);
  EXPECT_EQ(verdict(), Rejection::kNone);
  filter.match_hitpct_threshold = hits;  // "greater than"
  EXPECT_NE(verdict(), Rejection::kNone);
  filter.match_hitpct_threshold = 0.0;
  filter.match_max_dist = 0.31;
  EXPECT_EQ(verdict(), Rejection::kNone);
  filter.match_max_dist = 0.29;
  EXPECT_EQ(verdict(), Rejection::kDistance);
}

TEST_F(ClosureTest, FarMatchAwayFromTheExpectedPlaceNeedsTheHighThreshold) {
  filter.match_max_dist = 0.29;
  const double hits = find().value().inlier_ratio;
  filter.match_hitpct_threshold_high = below(hits);
  EXPECT_EQ(verdict(), Rejection::kNone);
  filter.match_hitpct_threshold_high = hits;
  EXPECT_EQ(verdict(), Rejection::kHits);
  filter.match_hitpct_threshold_high = 0.0;
  filter.match_max_dist_high = 0.31;
  EXPECT_EQ(verdict(), Rejection::kNone);
  filter.match_max_dist_high = 0.29;
  EXPECT_EQ(verdict(), Rejection::kDistance);
}

TEST_F(ClosureTest, OppositeIsSaidOfTheHeadingsBeforeTheMatch) {
  const double heading = between(map.graph.nodes[kCandidate].pose, map.graph.nodes[kQuery].pose).theta;
  EXPECT_NEAR(heading, kOffset.theta + kDisplacement.theta, 1e-12);          // not the true 1.0
  filter.match_hitpct_threshold = filter.match_hitpct_threshold_high = 1.0;  // refuse what is not opposite
  filter.opposite_dir_threshold = heading;                                   // "from this on"
  EXPECT_EQ(verdict(), Rejection::kNone);
  filter.opposite_dir_threshold = above(heading);
  EXPECT_EQ(verdict(), Rejection::kHits);
}

TEST_F(ClosureTest, OppositeMatchesHaveThresholdsOfTheirOwn) {
  filter.opposite_dir_threshold = 0.0;
  const double hits = find().value().inlier_ratio;
  filter.match_hitpct_threshold_high_opposite_dir = 1.0;
  filter.match_hitpct_threshold_opposite_dir = below(hits);
  EXPECT_EQ(verdict(), Rejection::kNone);
  filter.match_hitpct_threshold_opposite_dir = hits;
  EXPECT_EQ(verdict(), Rejection::kHits);
  filter.match_hitpct_threshold_high_opposite_dir = below(hits);  // the second key is the high one
  EXPECT_EQ(verdict(), Rejection::kNone);
  filter.match_max_dist_high = 0.29;
  EXPECT_NE(verdict(), Rejection::kNone);
}

TEST_F(ClosureTest, CloseMatchNeedsAtLeastItsHitThreshold) {
  set_close();
  filter.match_max_dist = filter.match_max_dist_high = 0.0;  // do not count here
  const double hits = find().value().inlier_ratio;
  filter.close_node_hitpct_threshold = hits;  // "at least"
  EXPECT_EQ(verdict(), Rejection::kNone);
  filter.close_node_hitpct_threshold = above(hits);
  EXPECT_EQ(verdict(), Rejection::kCloseHits);
}

TEST_F(ClosureTest, CloseMatchMayMoveAndTurnTheCandidateOnlySoFar) {
  set_close();
  filter.close_node_max_dist = 0.31;
  filter.match_max_ang_diff = 0.11;
  EXPECT_EQ(verdict(), Rejection::kNone);
  filter.close_node_max_dist = 0.29;
  EXPECT_EQ(verdict(), Rejection::kCloseDistance);
  filter.close_node_max_dist = 0.31;
  filter.match_max_ang_diff = 0.09;
  EXPECT_EQ(verdict(), Rejection::kAngle);
}

TEST_F(ClosureTest, CloseRulesCountForSmallerIdDistancesOnly) {
  filter.close_node_max_dist = 0.0;
  set_far();
  EXPECT_EQ(verdict(), Rejection::kNone);
  set_close();
  EXPECT_EQ(verdict(), Rejection::kCloseDistance);
}

TEST_F(ClosureTest, RoughAndFineMatchNeedTheirHits) {
  loop.frsm_matcher.rough_match_hitpct_threshold = above(1.0);
  EXPECT_EQ(verdict(), Rejection::kRoughHits);
  loop.frsm_matcher.rough_match_hitpct_threshold = 0.0;
  loop.frsm_matcher.fine_match_hitpct_threshold = above(1.0);
  EXPECT_EQ(verdict(), Rejection::kFineHits);
  loop.frsm_matcher.fine_match_hitpct_threshold = 0.0;
  const double hits = find().value().inlier_ratio;
  loop.frsm_matcher.fine_match_hitpct_threshold = hits;
  EXPECT_EQ(verdict(), Rejection::kNone);
}

TEST_F(ClosureTest, SmallSubmapsAreRefused) {
  const int neighbors = 14;  // the other nodes of the candidate's chain
  loop.frsm_matcher.submap_min_neighborhood_size = neighbors;
  EXPECT_EQ(verdict(), Rejection::kNone);
  loop.frsm_matcher.submap_min_neighborhood_size = neighbors + 1;
  EXPECT_EQ(verdict(), Rejection::kSmallSubmap);
}

TEST_F(ClosureTest, WhatLiesBeyondTheWindowIsNotBelieved) {
  loop.frsm_matcher.search_window_xy = 0.25;  // the truth is 0.27 m away along y
  EXPECT_EQ(verdict(), Rejection::kWindowBorder);
}

TEST_F(ClosureTest, AScanThatSeesNothingClosesNoLoop) {
  map.clouds.set(kQuery, PointCloud{kQuery, 0.0, {}});
  EXPECT_FALSE(find());
}

TEST_F(ClosureTest, EveryAttemptIsCountedOnce) {
  loop.candidate_search.knearest_neighbors = 3;
  loop.candidate_search.submap_neighborhood_size = 3;
  loop.candidate_search.closest_allowed_id_threshold_small = 1;
  loop.candidate_search.closest_allowed_id_threshold_large = 1;
  loop.frsm_matcher.submap_min_neighborhood_size = 2;  // the first and last node of the chain have one neighbour
  filter.match_max_dist = filter.match_max_dist_high = 0.31;
  const auto closures = find_all();
  EXPECT_EQ(counts.tried, 3u);
  EXPECT_EQ(counts.accepted, closures.size());
  EXPECT_EQ(counts.accepted + counts.rejected.total(), counts.tried);
}

}  // namespace
}  // namespace oort
