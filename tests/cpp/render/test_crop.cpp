// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/render/crop.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

Node node_at(double x, double y, double theta) {
  Node node;
  node.pose = Pose2{x, y, theta};
  return node;
}

const Eigen::AlignedBox2d kBox(Eigen::Vector2d(-10.0, -10.0), Eigen::Vector2d(10.0, 10.0));

TEST(Crop, KeepsTheNodesInTheBoxWithTheBeamsThatEndThere) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  PointCloud cloud;
  cloud.points = {{5.0, 0.0, 1.0}, {50.0, 0.0, 1.0}, {nan, 0.5, nan}, {0.0, 8.0, 1.0}};
  const Cropped cropped = crop({node_at(0.0, 4.0, 0.0), node_at(400.0, 0.0, 0.0)}, PointClouds({cloud, cloud}), kBox);
  ASSERT_EQ(cropped.nodes.size(), 1u);
  ASSERT_EQ(cropped.clouds.size(), 1u);
  const std::vector<Point2>& points = cropped.clouds[0].points;
  ASSERT_EQ(points.size(), 2u);  // the second ends at x 50, the last at y 12
  EXPECT_EQ(points[0].x, 5.0);
  EXPECT_FALSE(points[1].is_return());
}

TEST(Crop, RefusesWhatDoesNotFitTogether) {
  EXPECT_THROW(crop({node_at(0.0, 0.0, 0.0)}, PointClouds(), kBox), InputError);
  EXPECT_THROW(crop({}, PointClouds(), Eigen::AlignedBox2d()), InputError);
}

TEST(Choose, GivesTheNodesThatAreNamedAndRefusesOthers) {
  Map map;
  map.graph.nodes = {node_at(1.0, 0.0, 0.0), node_at(2.0, 0.0, 0.0)};
  map.clouds = PointClouds({PointCloud{}, PointCloud{}});
  const Cropped chosen = choose(map, {1});
  ASSERT_EQ(chosen.nodes.size(), 1u);
  ASSERT_EQ(chosen.clouds.size(), 1u);
  EXPECT_EQ(chosen.nodes[0].pose.x, 2.0);
  EXPECT_THROW(choose(map, {0, 2}), InputError);
  EXPECT_THROW(choose(map, {std::numeric_limits<std::uint64_t>::max()}), InputError);
}

}  // namespace
}  // namespace oort
