// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// A session that goes on and on: its map is reduced while it grows.
#include <gtest/gtest.h>

#include <algorithm>

#include "mapping_fixtures.hpp"
#include "oort/map/locations.hpp"
#include "oort/map/map_check.hpp"
#include "oort/mapper/mapper.hpp"

namespace oort {
namespace {

using testing::kMount;
using testing::laps;
using testing::make_room;
using testing::odometry_of;
using testing::see;

/// A node every 6 cm.
Parameters dense(bool threaded, int keep_views = 1) {
  Parameters parameters;
  parameters.linear_update = 0.06;
  parameters.keep_views = keep_views;
  parameters.global_slam_thread = threaded;
  return parameters;
}

struct Followed {
  std::uint64_t node = 0;
  Pose2 T_node_sensor;
};

/// A long drive in one session, with a place named and its node's fate followed
/// on the way.
struct LongDrive {
  explicit LongDrive(const Parameters& parameters, double count = 7.0)
      : mapper(parameters, kMount), truth(laps(count)) {
    const auto world = make_room();
    const std::vector<Pose2> odometry = odometry_of(truth, 0.01, 0.01);
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const LaserScan scan = see(world, truth[k] * kMount, 100.0 + 0.3 * static_cast<double>(k));
      const ScanResult result = mapper.add_scan(scan, odometry[k]);
      follow();
      scans.push_back({result.node_id.value(), result.T_node_sensor});
      most_nodes = std::max(most_nodes, mapper.map().graph.nodes.size());
      if (k == 300) mapper.create_location("place", "here", mapper.sensor_pose());
    }
    mapper.finish();
    follow();
  }

  void follow() {
    const std::optional<Renumbering> nodes = mapper.take_renumbering();
    if (!nodes) return;
    ++reductions;
    for (Followed& scan : scans) {
      scan.T_node_sensor = nodes->T_carrier_node[scan.node] * scan.T_node_sensor;
      scan.node = nodes->carrier[scan.node];
    }
  }

  /// How far a scan is from where it truly was [m].
  double error(std::size_t scan) const {
    const Pose2 pose = mapper.map().graph.nodes[scans[scan].node].pose * scans[scan].T_node_sensor;
    return between(between(truth.front() * kMount, truth[scan] * kMount), pose).translation().norm();
  }

  Mapper mapper;
  std::vector<Pose2> truth;
  std::vector<Followed> scans;
  std::size_t most_nodes = 0;
  int reductions = 0;
};

const LongDrive& long_drive() {
  static const LongDrive drive(dense(true));
  return drive;
}

TEST(Reduction, BoundsTheMapOfASessionThatGoesOn) {
  const LongDrive& drive = long_drive();
  EXPECT_GE(drive.reductions, 1);
  EXPECT_LT(drive.most_nodes, 1060u);  // of 1065
  EXPECT_LT(drive.mapper.map().graph.nodes.size(), 800u);
  EXPECT_EQ(find_defect(drive.mapper.map()), std::nullopt);
}

TEST(Reduction, ScansAndPlacesStayWhereTheyWere) {
  const LongDrive& drive = long_drive();
  for (std::size_t scan = 0; scan < drive.scans.size(); ++scan) ASSERT_LT(drive.error(scan), 0.06) << "scan " << scan;
  const Pose2 place = between(drive.truth.front() * kMount, drive.truth[300] * kMount);
  EXPECT_LT((locate(drive.mapper.map(), "place", "here")->translation() - place.translation()).norm(), 0.06);
}

TEST(Reduction, IsTheSameWithTheThreadAndWithout) {
  const LongDrive other(dense(false));
  const Map& a = long_drive().mapper.map();
  const Map& b = other.mapper.map();
  ASSERT_EQ(a.graph.nodes.size(), b.graph.nodes.size());
  for (std::size_t k = 0; k < a.graph.nodes.size(); ++k) {
    ASSERT_EQ(a.graph.nodes[k].pose.x, b.graph.nodes[k].pose.x) << "node " << k;
    ASSERT_EQ(a.graph.nodes[k].pose.theta, b.graph.nodes[k].pose.theta) << "node " << k;
  }
  ASSERT_EQ(a.graph.switchable_edges.size(), b.graph.switchable_edges.size());
}

TEST(Reduction, LeavesAMapThatShowsNothingTooOften) {
  const LongDrive drive(dense(true, 1000), 5.0);
  EXPECT_EQ(drive.reductions, 0);
}

TEST(Renumbering, OneAfterTheOther) {
  // Of four nodes the second goes, then one comes, then of the four the second
  // again.
  const Renumbering first{{true, false, true, true}, {0, 0, 1, 2}, {{}, {1.0, 0.0, 0.0}, {}, {}}, 3};
  const Renumbering second{{true, false, true, true}, {0, 0, 1, 2}, {{}, {2.0, 0.0, 0.0}, {}, {}}, 3};
  const Renumbering both = first * second;
  EXPECT_EQ(both.kept, (std::vector<bool>{true, false, false, true, true}));
  EXPECT_EQ(both.carrier, (std::vector<std::uint64_t>{0, 0, 0, 1, 2}));
  EXPECT_EQ(both.T_carrier_node[1].x, 1.0);
  EXPECT_EQ(both.T_carrier_node[2].x, 2.0);
  EXPECT_EQ(both.of(5), 3u);
  EXPECT_EQ(both.left_before(3), 1u);
}

}  // namespace
}  // namespace oort
