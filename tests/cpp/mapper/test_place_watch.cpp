// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// A robot that is not where the map has it is noticed by what it sees through what must be free (docs/tracking.md).
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "mapping_fixtures.hpp"
#include "oort/mapper/place_watch.hpp"

namespace oort {
namespace {

using namespace testing;

/// Nodes on three laps of the room; from one on the robot is truly elsewhere.
class PlaceWatchTest : public ::testing::Test {
 protected:
  PlaceWatchTest() {
    const std::vector<Pose2> way = laps(3.0);
    for (std::size_t k = 0; k < 60; ++k) places_.push_back(way[k * way.size() / 60]);
    append_chain(make_room(), places_, {}, map_, segments_);
  }

  /// What is suspect if the nodes from `carried` on truly were elsewhere.
  std::optional<std::uint64_t> suspect(std::size_t carried) {
    PlaceWatch watch;
    std::optional<std::uint64_t> first;
    for (std::uint64_t node = 0; node < places_.size() && !first; ++node) {
      if (node >= carried) {
        const Pose2 truth = Pose2{0.0, 0.0, kPi} * places_[node];
        map_.clouds.set(node, to_point_cloud(see(make_room(), truth, 0.0)));
      }
      watch.look(map_, node, nullptr);
      first = watch.first_suspect();
    }
    return first;
  }

  std::vector<Pose2> places_;
  Map map_;
  TrajectorySegments segments_;
};

TEST_F(PlaceWatchTest, NothingIsSuspectWhereScansFitTheMap) {
  EXPECT_EQ(suspect(1000), std::nullopt);
}

TEST_F(PlaceWatchTest, NodesThatSeeThroughWallsAreSuspectFromTheFirstOn) {
  const std::optional<std::uint64_t> first = suspect(45);
  ASSERT_TRUE(first);
  EXPECT_GE(*first, 45u);
  EXPECT_LE(*first, 48u);
}

TEST_F(PlaceWatchTest, TwoSuchNodesAreNone) {
  EXPECT_EQ(suspect(58), std::nullopt);
}

}  // namespace
}  // namespace oort
