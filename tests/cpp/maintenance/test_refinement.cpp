// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/refinement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mapping_fixtures.hpp"
#include "oort/maintenance/scan_alignment.hpp"
#include "oort/maintenance/view_pairs.hpp"

namespace oort {
namespace {

using testing::append_chain;
using testing::laps;
using testing::make_room;
using testing::see;
using testing::Sensor;
using testing::World;

constexpr double kSigma = 0.01;        // [m] of a chain link
constexpr double kSigmaTheta = 0.005;  // [rad]

std::vector<SurfacePiece> pieces_seen(const World& world, const Pose2& place, const Sensor& sensor = {}) {
  return surface_pieces(to_point_cloud(see(world, place, 0.0, sensor)));
}

/// Two walls along x, 2 m apart, whose ends nothing sees.
World corridor() {
  return {{{-50.0, -1.0}, {50.0, -1.0}}, {{50.0, 1.0}, {-50.0, 1.0}}};
}

/// A map whose chain was measured with noise, and whose nodes are where the chain puts them.
Map drifted_map(const World& world, const std::vector<Pose2>& places, std::uint64_t seed) {
  Map map;
  TrajectorySegments segments;
  append_chain(world, places, Sensor{}, map, segments);
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  for (std::uint64_t k = 1; k < places.size(); ++k) {
    const double x = normal(generator), y = normal(generator), theta = normal(generator);
    const Pose2 measured = between(places[k - 1], places[k]) * Pose2{kSigma * x, kSigma * y, kSigmaTheta * theta};
    const Eigen::Vector3d sigmas(kSigma, kSigma, kSigmaTheta);
    map.graph.edges.push_back({k - 1, k - 1, k, {0.0, k, measured, sigmas.cwiseAbs2().asDiagonal()}});
    map.graph.nodes[k].pose = map.graph.nodes[k - 1].pose * measured;
  }
  return map;
}

std::vector<Pose2> every(std::size_t stride, const std::vector<Pose2>& all) {
  std::vector<Pose2> some;
  for (std::size_t k = 0; k < all.size(); k += stride) some.push_back(all[k]);
  return some;
}

double position_error(const Map& map, const std::vector<Pose2>& truth) {
  double sum = 0.0;
  for (const Node& node : map.graph.nodes) {
    sum += (node.pose.translation() - truth[node.id].translation()).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

TEST(SurfacePieces, LieOnTheWallsAndFaceTheSensor) {
  const Pose2 place{0.3, 0.2, -0.7};
  const std::vector<SurfacePiece> pieces = transformed(place, pieces_seen(corridor(), place));
  ASSERT_GT(pieces.size(), 10u);
  for (const SurfacePiece& piece : pieces) {
    EXPECT_NEAR(std::abs(piece.center.y()), 1.0, 1e-5);
    EXPECT_NEAR(piece.normal.y(), piece.center.y() > 0.0 ? -1.0 : 1.0, 1e-6);
  }
}

TEST(SurfacePieces, LeavesOutWhatIsNoReturnAndWhatIsNoLine) {
  PointCloud cloud;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < 10; ++k) cloud.points.push_back({1.0, 0.1 * k, nan});
  EXPECT_TRUE(surface_pieces(cloud).empty());
  cloud.points = {{1.0, 0.0}, {1.0, 0.1}, {1.1, 0.1}, {1.1, 0.0}};  // around a square
  EXPECT_TRUE(surface_pieces(cloud).empty());
  EXPECT_TRUE(surface_pieces(PointCloud{}).empty());
}

TEST(ScanAlignment, FindsTheTrueTransform) {
  const World room = make_room();
  const Pose2 a{-1.5, -1.2, 0.3}, b{-1.2, -1.1, 0.6};
  const std::vector<SurfacePiece> pieces_a = pieces_seen(room, a), pieces_b = pieces_seen(room, b);
  Pose2 T = between(a, b) * Pose2{0.05, -0.04, 0.03};
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d c = align(pieces_a, pieces_b, T, 0.2).correction;
    T = {T.x + c.x(), T.y + c.y(), T.theta + c.z()};
  }
  const Pose2 error = between(between(a, b), T);
  EXPECT_LT(error.translation().norm(), 0.003);
  EXPECT_LT(std::abs(error.theta), 0.002);
}

TEST(ScanAlignment, SaysNothingAlongACorridor) {
  const Pose2 a{0.0, 0.1, 0.2};
  const Pose2 T{0.5, 0.0, 0.1};
  const ScanAlignment alignment =
      align(pieces_seen(corridor(), a), pieces_seen(corridor(), a * T), T * Pose2{0.04, 0.03, 0.01}, 0.2);
  ASSERT_GT(alignment.pairs, 8);
  const Eigen::Vector3d axis(std::cos(-a.theta), std::sin(-a.theta), 0.0);  // of the corridor, seen from a
  const Eigen::Vector3d across(-axis.y(), axis.x(), 0.0);
  EXPECT_LT((alignment.W * axis).norm(), 0.02 * (alignment.W * across).norm());
  EXPECT_LT(std::abs(alignment.correction.dot(axis)), 0.002);
  EXPECT_GT(alignment.correction.dot(-across), 0.02);
}

TEST(ScanAlignment, DoesNotPairTheTwoSidesOfAWall) {
  const std::vector<SurfacePiece> left = pieces_seen({{{-2.0, 0.0}, {2.0, 0.0}}}, {0.0, 1.0, -1.57});
  const std::vector<SurfacePiece> right = pieces_seen({{{-2.0, -0.05}, {2.0, -0.05}}}, {0.0, -1.0, 1.57});
  ASSERT_FALSE(left.empty());
  ASSERT_FALSE(right.empty());
  EXPECT_EQ(align(left, right, between({0.0, 1.0, -1.57}, {0.0, -1.0, 1.57}), 0.2).pairs, 0);
}

TEST(ViewPairs, AreOfEarlierNodesThatSawThePlace) {
  const World room = make_room();
  const std::vector<Pose2> places = every(5, laps(2.0));
  std::vector<std::vector<SurfacePiece>> pieces;
  for (const Pose2& place : places) pieces.push_back(pieces_seen(room, place));
  pieces[7].clear();
  std::vector<int> partners(places.size(), 0);
  for (const auto& [i, j] : view_pairs(places, pieces)) {
    EXPECT_LT(i, j);
    EXPECT_NE(i, 7u);
    EXPECT_NE(j, 7u);
    EXPECT_LE(++partners[j], 8);
  }
  EXPECT_GT(partners.back(), 3);
}

class RefinementOf : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(RefinementOf, ARoomComesCloserToTheTruth) {
  const std::vector<Pose2> truth = every(5, laps(2.0));
  Map map = drifted_map(make_room(), truth, GetParam());
  const Map before = map;
  const RefinementCounts counts = refine(map);
  EXPECT_TRUE(counts.kept);
  EXPECT_GT(counts.links.accepted, truth.size());
  EXPECT_LT(counts.misfit, 0.5 * counts.misfit_before);
  EXPECT_LT(position_error(map, truth), 0.3 * position_error(before, truth));
  EXPECT_EQ(map.graph.nodes[0].pose.x, before.graph.nodes[0].pose.x);
  EXPECT_EQ(map.graph.edges.size(), before.graph.edges.size());
}

INSTANTIATE_TEST_SUITE_P(Seeds, RefinementOf, ::testing::Values(1, 2, 3));

TEST(Refinement, MovesNothingAlongACorridor) {
  std::vector<Pose2> truth;
  for (int k = 0; k < 40; ++k) truth.push_back({0.2 * k, 0.1 * std::sin(0.3 * k), 0.05 * std::cos(0.3 * k)});
  Map map = drifted_map(corridor(), truth, 4);
  const Map before = map;
  refine(map);
  double along = 0.0, across_before = 0.0, across = 0.0;
  for (const Node& node : map.graph.nodes) {
    const Pose2& was = before.graph.nodes[node.id].pose;
    along = std::max(along, std::abs(node.pose.x - was.x));
    across = std::max(across, std::abs(node.pose.y - truth[node.id].y));
    across_before = std::max(across_before, std::abs(was.y - truth[node.id].y));
  }
  EXPECT_LT(along, 0.01);
  EXPECT_LT(across, 0.5 * across_before);
}

TEST(Refinement, IsDeterministicAndLeavesARefinedMapAlone) {
  const std::vector<Pose2> truth = every(5, laps(1.5));
  Map one = drifted_map(make_room(), truth, 5);
  Map other = one;
  refine(one);
  refine(other);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_EQ(one.graph.nodes[k].pose.x, other.graph.nodes[k].pose.x);
    EXPECT_EQ(one.graph.nodes[k].pose.theta, other.graph.nodes[k].pose.theta);
  }
  refine(other);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_LT((one.graph.nodes[k].pose.translation() - other.graph.nodes[k].pose.translation()).norm(), 0.005);
  }
}

TEST(Refinement, OfMapsWithNothingToCompare) {
  Map empty;
  EXPECT_EQ(refine(empty).links.tried, 0u);
  Map blind = drifted_map({}, {{0.0, 0.0, 0.0}, {0.2, 0.0, 0.0}}, 1);
  const Pose2 before = blind.graph.nodes[1].pose;
  EXPECT_FALSE(refine(blind).kept);
  EXPECT_EQ(blind.graph.nodes[1].pose.x, before.x);
}

}  // namespace
}  // namespace oort
