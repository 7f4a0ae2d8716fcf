// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Segments of nodes that were tracked in one go, and the submaps drawn from them.
#include <gtest/gtest.h>

#include "mapping_fixtures.hpp"
#include "oort/loop_closure/submaps.hpp"

namespace oort {
namespace {

using testing::append_chain;
using testing::drive;
using testing::laps;
using testing::make_room;
using testing::World;
using Ids = std::vector<std::uint64_t>;

TrajectorySegments make_segments(const std::vector<int>& sizes) {
  TrajectorySegments segments;
  for (const int size : sizes) {
    for (int k = 0; k < size; ++k) segments.add(k == 0, true, {0.1 * k, 0.0, 0.0});
  }
  return segments;
}

TEST(TrajectorySegments, KnowWhereSegmentsBeginAndEnd) {
  const TrajectorySegments segments = make_segments({3, 1, 4});
  ASSERT_EQ(segments.size(), 8u);
  const Ids begins{0, 0, 0, 3, 4, 4, 4, 4};
  const Ids ends{3, 3, 3, 4, 8, 8, 8, 8};
  for (std::uint64_t k = 0; k < 8; ++k) {
    EXPECT_EQ(segments.segment_begin(k), begins[k]) << k;
    EXPECT_EQ(segments.segment_end(k), ends[k]) << k;
  }
  EXPECT_TRUE(segments.same_segment(4, 7));
  EXPECT_FALSE(segments.same_segment(3, 4));
}

TEST(TrajectorySegments, ASegmentIsSplit) {
  TrajectorySegments segments = make_segments({3, 5, 4});
  segments.split(5);
  const Ids begins{0, 0, 0, 3, 3, 5, 5, 5, 8, 8, 8, 8};
  for (std::uint64_t k = 0; k < begins.size(); ++k) EXPECT_EQ(segments.segment_begin(k), begins[k]) << k;
  EXPECT_EQ(segments.segment_end(3), 5u);
  EXPECT_EQ(segments.neighborhood(5, 5), (Ids{5, 6, 7}));
}

TEST(TrajectorySegments, TheFirstNodeBeginsASegmentWhateverIsSaid) {
  TrajectorySegments segments;
  segments.add(false, true, {1.0, 2.0, 3.0});
  EXPECT_EQ(segments.segment_begin(0), 0u);
  EXPECT_DOUBLE_EQ(segments.local_pose(0).y, 2.0);
}

TEST(TrajectorySegments, NeighborhoodIsAsMuchOfTheSegmentAsFits) {
  const TrajectorySegments segments = make_segments({2, 10, 3});
  EXPECT_EQ(segments.neighborhood(7, 5), (Ids{5, 6, 7, 8, 9}));
  EXPECT_EQ(segments.neighborhood(7, 4), (Ids{5, 6, 7, 8}));
  EXPECT_EQ(segments.neighborhood(2, 5), (Ids{2, 3, 4, 5, 6}));  // the beginning moves the window on
  EXPECT_EQ(segments.neighborhood(11, 5), (Ids{9, 10, 11}));     // the end cuts it: more may come later
  EXPECT_EQ(segments.neighborhood(13, 100), (Ids{12, 13, 14}));
  EXPECT_EQ(segments.neighborhood(7, 1), (Ids{7}));
}

TEST(TrajectorySegments, NodesThatAreFarApartCountAsSeveral) {
  TrajectorySegments segments;
  for (int k = 0; k < 8; ++k) segments.add(k == 0, true, {1.2 * k, 0.0, 0.0});
  EXPECT_EQ(segments.travel_between(2, 4), 6u);
  EXPECT_EQ(segments.travel_between(4, 2), 6u);
  EXPECT_EQ(segments.neighborhood(4, 7), (Ids{3, 4, 5}));
  EXPECT_TRUE(segments.begins_stride(0, 4));
  EXPECT_FALSE(segments.begins_stride(1, 4));
  EXPECT_TRUE(segments.begins_stride(2, 4));
  EXPECT_TRUE(segments.begins_stride(3, 4));
}

TEST(TrajectorySegments, NeighborhoodLeavesOutWhatOdometryPlacedButNotTheNodeItself) {
  TrajectorySegments segments;
  for (int k = 0; k < 7; ++k) segments.add(false, k != 2 && k != 4, {});
  EXPECT_EQ(segments.neighborhood(3, 7), (Ids{0, 1, 3, 5, 6}));
  EXPECT_EQ(segments.neighborhood(4, 3), (Ids{3, 4, 5}));
  EXPECT_FALSE(segments.is_matched(2));
}

TEST(TrajectorySegments, AreRecoveredFromAMap) {
  const World world = make_room();
  const std::vector<Pose2> truth = laps(0.4);
  Mapper mapper(Parameters{}, testing::kMount);
  drive(mapper, world, truth, truth);
  const std::uint64_t paused = mapper.map().graph.nodes.size();
  mapper.resume_from_paused();
  drive(mapper, world, truth, truth, 200.0);
  const std::uint64_t resumed = mapper.map().graph.nodes.size();
  mapper.begin_session(testing::kMount);
  drive(mapper, world, truth, truth, 300.0);
  const Map& map = mapper.map();
  ASSERT_GT(paused, 3u);
  ASSERT_EQ(resumed, 2 * paused);

  const TrajectorySegments segments = TrajectorySegments::of_map(map);
  ASSERT_EQ(segments.size(), 3 * paused);
  for (std::uint64_t node = 0; node < segments.size(); ++node) {
    EXPECT_EQ(segments.segment_begin(node), node / paused * paused) << node;
    EXPECT_TRUE(segments.is_matched(node)) << node;
    const std::uint64_t begin = segments.segment_begin(node);
    const Pose2 recovered = between(segments.local_pose(begin), segments.local_pose(node));
    const Pose2 tracked = between(map.incremental_results[begin].T_local_id, map.incremental_results[node].T_local_id);
    EXPECT_NEAR(recovered.x, tracked.x, 1e-9);
    EXPECT_NEAR(recovered.y, tracked.y, 1e-9);
    EXPECT_NEAR(wrap_angle(recovered.theta - tracked.theta), 0.0, 1e-9);
  }
}

TEST(TrajectorySegments, OfAMapWithoutLinksAreSingleNodes) {
  Map map;
  for (std::uint64_t id = 0; id < 3; ++id) map.graph.nodes.push_back({id, {}});
  const TrajectorySegments segments = TrajectorySegments::of_map(map);
  for (std::uint64_t id = 0; id < 3; ++id) EXPECT_EQ(segments.segment_begin(id), id);
  EXPECT_EQ(TrajectorySegments::of_map(Map{}).size(), 0u);
}

class SubmapCacheTest : public ::testing::Test {
 protected:
  SubmapCacheTest() {
    const std::vector<Pose2> truth = laps(0.6);
    std::vector<Pose2> places;
    for (std::size_t k = 0; k < truth.size(); k += 6) places.push_back(truth[k]);
    append_chain(make_room(), places, {}, map, segments);
  }

  using TableCache = SubmapCache<frsm::Table>;
  TableCache cache(std::size_t capacity) const {
    return table_cache(7, capacity, frsm::TableParams{}, frsm::ContourParams{});
  }

  Map map;
  TrajectorySegments segments;
};

void expect_equal(const frsm::Table& a, const frsm::Table& b) {
  const frsm::TableView va = a.view();
  const frsm::TableView vb = b.view();
  ASSERT_EQ(va.x0, vb.x0);
  ASSERT_EQ(va.y0, vb.y0);
  ASSERT_EQ(va.width, vb.width);
  ASSERT_EQ(va.height, vb.height);
  int drawn = 0;
  for (int iy = va.y0; iy < va.y0 + va.height; ++iy) {
    for (int ix = va.x0; ix < va.x0 + va.width; ++ix) {
      ASSERT_EQ(a.value(ix, iy), b.value(ix, iy)) << ix << ' ' << iy;
      drawn += a.value(ix, iy) > 0;
    }
  }
  EXPECT_GT(drawn, 1000);
}

TEST_F(SubmapCacheTest, ServesFromMemoryAndRedrawsTheSame) {
  ASSERT_GT(map.clouds.size(), 20u);
  TableCache large = cache(64);
  const auto first = large.get(map, segments, 10);
  EXPECT_EQ(large.get(map, segments, 10), first);  // not drawn again

  TableCache small = cache(1);
  const auto drawn = small.get(map, segments, 10);
  small.get(map, segments, 3);
  const auto redrawn = small.get(map, segments, 10);
  EXPECT_NE(redrawn, drawn);
  expect_equal(*redrawn, *drawn);
  expect_equal(*redrawn, *first);
}

TEST_F(SubmapCacheTest, OrderOfQueriesDoesNotMatter) {
  TableCache forward = cache(3);
  TableCache backward = cache(3);
  std::vector<std::shared_ptr<const frsm::Table>> tables(12);
  for (std::uint64_t node = 0; node < 12; ++node) tables[node] = forward.get(map, segments, node);
  for (std::uint64_t node = 12; node-- > 0;) expect_equal(*backward.get(map, segments, node), *tables[node]);
}

TEST_F(SubmapCacheTest, FollowsANeighborhoodThatGrows) {
  TableCache grown = cache(64);
  TrajectorySegments young;
  for (std::uint64_t node = 0; node < segments.size(); ++node) {
    young.add(node == 0, true, segments.local_pose(node));
    if (node >= 10) grown.get(map, young, 10);
  }
  expect_equal(*grown.get(map, young, 10), *cache(64).get(map, segments, 10));
}

TEST_F(SubmapCacheTest, MayBeDrawnPieceByPiece) {
  TableCache pieces = cache(64);
  int steps = 0;
  while (pieces.draw(map, segments, 10, 3)) ++steps;
  EXPECT_EQ(steps, 3);  // 7 scans
  expect_equal(*pieces.get(map, segments, 10), *cache(64).get(map, segments, 10));
  pieces.draw(map, segments, 14, 3);  // what is half drawn is finished when it is asked for
  expect_equal(*pieces.get(map, segments, 14), *cache(64).get(map, segments, 14));
}

TEST_F(SubmapCacheTest, IsInTheFrameOfItsNode) {
  Map turned = map;
  TrajectorySegments moved;
  const Pose2 T_other_local{30.0, -20.0, 1.0};  // where a segment's frame lies must not matter
  for (std::uint64_t node = 0; node < segments.size(); ++node) {
    moved.add(node == 0, true, T_other_local * segments.local_pose(node));
  }
  const auto here = cache(1).get(map, segments, 5);
  const auto there = cache(1).get(turned, moved, 5);
  long difference = 0;
  const frsm::TableView view = here->view();
  for (int iy = view.y0; iy < view.y0 + view.height; ++iy) {
    for (int ix = view.x0; ix < view.x0 + view.width; ++ix) {
      difference = std::max<long>(difference, std::abs(here->value(ix, iy) - there->value(ix, iy)));
    }
  }
  EXPECT_LE(difference, 2);  // rounding only
}

}  // namespace
}  // namespace oort
