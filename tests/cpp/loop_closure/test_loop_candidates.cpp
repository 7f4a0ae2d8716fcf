// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Where loops are looked for.
#include <gtest/gtest.h>

#include "mapping_fixtures.hpp"
#include "oort/loop_closure/loop_closure_builder.hpp"

namespace oort {
namespace {

using Ids = std::vector<std::uint64_t>;

/// The documented search, whatever the defaults are.
Parameters documented_search() {
  Parameters parameters = testing::documented_parameters();
  CandidateSearchParameters& search = parameters.loop_closure_graph_builder.candidate_search;
  EXPECT_EQ(search.knearest_neighbors, 5);
  EXPECT_EQ(search.submap_neighborhood_size, 15);  // so that 8 hops are excluded
  EXPECT_EQ(search.closest_allowed_id_threshold_large, 30);
  EXPECT_EQ(search.closest_allowed_id_threshold_small, 5);
  EXPECT_EQ(search.candidate_stride, 1);
  EXPECT_EQ(search.max_candidate_distance, 0.0);
  return parameters;
}

class CandidatesTest : public ::testing::Test {
 protected:
  void add(double x, bool begins_segment = false) {
    const std::uint64_t id = map.graph.nodes.size();
    map.graph.nodes.push_back({id, {x, 0.0, 0.0}});
    map.clouds.push_back({id, 0.0, {}});
    segments.add(begins_segment, true, {x, 0.0, 0.0});
  }

  /// Out along the x axis and back, 0.2 m a node: nodes k and 2 * half - 1 - k are at the same place.
  void go_out_and_back(int half) {
    for (int k = 0; k < half; ++k) add(0.2 * k);
    for (int k = half; k-- > 0;) add(0.2 * k);
  }

  Ids candidates(std::uint64_t query) const { return LoopClosureBuilder(parameters).candidates(map, segments, query); }

  Map map;
  TrajectorySegments segments;
  Parameters parameters = documented_search();
};

TEST_F(CandidatesTest, AreTheNearestOutsideEachOthersNeighborhoods) {
  go_out_and_back(50);  // 99 is back where 0 was
  // 9 hops apart on the way out; the fifth is 69, 6 m away on the way back and 30 ids from the query: 36 is at 7.2 m.
  EXPECT_EQ(candidates(99), (Ids{0, 9, 18, 27, 69}));
}

TEST_F(CandidatesTest, NumberAndDistanceAreLimited) {
  go_out_and_back(50);
  CandidateSearchParameters& search = parameters.loop_closure_graph_builder.candidate_search;
  search.knearest_neighbors = 2;
  EXPECT_EQ(candidates(99), (Ids{0, 9}));
  search.knearest_neighbors = 0;
  EXPECT_EQ(candidates(99), Ids{});
  search.knearest_neighbors = 5;
  search.max_candidate_distance = 3.61;
  EXPECT_EQ(candidates(99), (Ids{0, 9, 18}));
  search.max_candidate_distance = 3.59;
  EXPECT_EQ(candidates(99), (Ids{0, 9}));
}

TEST_F(CandidatesTest, NeighborhoodSizeSetsTheHops) {
  go_out_and_back(50);
  CandidateSearchParameters& search = parameters.loop_closure_graph_builder.candidate_search;
  search.submap_neighborhood_size = 1;  // one hop
  EXPECT_EQ(candidates(99), (Ids{0, 2, 4, 6, 8}));
  search.submap_neighborhood_size = 4;  // two
  EXPECT_EQ(candidates(99), (Ids{0, 3, 6, 9, 12}));
  search.submap_neighborhood_size = 5;  // three
  EXPECT_EQ(candidates(99), (Ids{0, 4, 8, 12, 16}));
}

TEST_F(CandidatesTest, StrideCountsFromTheBeginningOfTheSegment) {
  for (int k = 0; k < 3; ++k) add(100.0 + k);
  add(0.0, true);  // node 3
  for (int k = 1; k < 50; ++k) add(0.2 * k);
  for (int k = 50; k-- > 0;) add(0.2 * k);
  CandidateSearchParameters& search = parameters.loop_closure_graph_builder.candidate_search;
  search.candidate_stride = 4;
  search.knearest_neighbors = 3;
  EXPECT_EQ(candidates(102), (Ids{3, 15, 27}));  // 12 hops: 9 are needed, and every fourth serves
}

TEST_F(CandidatesTest, IdsDifferByTheLargeThresholdAtLeast) {
  for (int k = 0; k < 100; ++k) add(0.01 * k);  // the nearest are the latest
  CandidateSearchParameters& search = parameters.loop_closure_graph_builder.candidate_search;
  search.knearest_neighbors = 1;
  EXPECT_EQ(candidates(99), (Ids{69}));
  EXPECT_EQ(candidates(20), (Ids{50}));  // the query need not be the newest
  search.closest_allowed_id_threshold_large = 31;
  EXPECT_EQ(candidates(99), (Ids{68}));
}

TEST_F(CandidatesTest, TheSmallThresholdCountsOnlyWhereTheLargeOneFindsNone) {
  go_out_and_back(10);  // 0...19
  EXPECT_EQ(candidates(19), (Ids{0, 9}));
  CandidateSearchParameters& search = parameters.loop_closure_graph_builder.candidate_search;
  search.closest_allowed_id_threshold_small = 19;
  EXPECT_EQ(candidates(19), (Ids{0}));
  search.closest_allowed_id_threshold_small = 20;
  EXPECT_EQ(candidates(19), Ids{});
  search.closest_allowed_id_threshold_small = 5;
  search.closest_allowed_id_threshold_large = 19;
  EXPECT_EQ(candidates(19), (Ids{0}));  // found by the large one: no second search
}

TEST_F(CandidatesTest, TheQueryExcludesItsOwnNeighborhood) {
  // The published map: nodes 0 to 3 differ by 5 ids from node 8, yet no loop was looked for there.
  for (int k = 0; k < 9; ++k) add(0.0);
  EXPECT_EQ(candidates(8), Ids{});
  add(0.0);
  EXPECT_EQ(candidates(9), (Ids{0}));  // nine hops
}

TEST_F(CandidatesTest, NeighborhoodsEndWithTheirSegment) {
  for (int k = 0; k < 4; ++k) add(0.0);
  for (int k = 0; k < 4; ++k) add(0.1, k == 0);
  add(0.0, true);
  EXPECT_EQ(candidates(8), (Ids{0, 4}));  // 1 to 3 are near 0, 5 to 7 near 4; ids count within a segment only
}

TEST_F(CandidatesTest, EquallyNearOnesAreInTheOrderOfTheirIds) {
  for (int k = 0; k < 60; ++k) add(k % 2 == 0 ? 0.1 : -0.1);
  add(0.0);
  EXPECT_EQ(candidates(60), (Ids{0, 9, 18, 27}));
}

}  // namespace
}  // namespace oort
