// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/relative_uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace oort {
namespace {

const Eigen::Matrix3d kStep = Eigen::Vector3d(1e-4, 4e-4, 1e-4).asDiagonal();

/// A chain of nodes a metre apart, each measured from the one before, that turns by `turn` at each.
Graph chain(std::size_t size, double turn = 0.0) {
  Graph graph;
  Pose2 pose;
  for (std::size_t k = 0; k < size; ++k) {
    graph.nodes.push_back({k, pose});
    if (k > 0) graph.edges.push_back({k - 1, k - 1, k, {0.0, k, {1.0, 0.0, turn}, kStep, ConstraintType::kLaser}});
    pose = pose * Pose2{1.0, 0.0, turn};
  }
  return graph;
}

TEST(RelativeUncertainty, IsTheCompoundOfTheChain) {
  const Graph graph = chain(12, 0.3);
  RelativeUncertainty uncertainty;
  uncertainty.update(graph);
  const auto known = uncertainty.from(graph, 2);
  EXPECT_TRUE(known[2]->isZero(0.0));
  // Along the axes of node 2, link by link (Smith, Self, Cheeseman 1990).
  Pose2 T_2_k;
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  for (std::size_t k = 3; k < graph.nodes.size(); ++k) {
    expected = compound_covariance(T_2_k, expected, graph.edges[k - 1].constraint.T_i_j, kStep);
    T_2_k = T_2_k * graph.edges[k - 1].constraint.T_i_j;
    const Eigen::Matrix3d found = rotate_covariance(*known[k], -graph.nodes[2].pose.theta);
    EXPECT_TRUE(found.isApprox(expected, 1e-9)) << k << "\n" << found << "\n\n" << expected;
  }
}

TEST(RelativeUncertainty, GoesBackwardsAlongLinks) {
  const Graph graph = chain(6, -0.4);
  RelativeUncertainty uncertainty;
  uncertainty.update(graph);
  const auto from_end = uncertainty.from(graph, 5);
  const auto from_begin = uncertainty.from(graph, 0);
  const Eigen::Matrix3d forward = rotate_covariance(*from_begin[5], -graph.nodes[0].pose.theta);
  const Eigen::Matrix3d expected = inverse_covariance(between(graph.nodes[0].pose, graph.nodes[5].pose), forward);
  const Eigen::Matrix3d backward = rotate_covariance(*from_end[0], -graph.nodes[5].pose.theta);
  EXPECT_TRUE(backward.isApprox(expected, 1e-9)) << backward << "\n\n" << expected;
}

TEST(RelativeUncertainty, AClosureShortensTheWayAsLongAsItIsOn) {
  Graph graph = chain(30);
  RelativeUncertainty uncertainty;
  uncertainty.update(graph);
  const double open = uncertainty.from(graph, 0)[29]->trace();
  graph.switchable_edges.push_back(
      {29, 29, 0, {0.0, 29, between(graph.nodes[29].pose, graph.nodes[0].pose), kStep, ConstraintType::kLaser}, 1.0});
  uncertainty.update(graph);
  EXPECT_LT(uncertainty.from(graph, 0)[29]->trace(), 0.2 * open);
  graph.switchable_edges[0].switch_value = 0.1;
  EXPECT_DOUBLE_EQ(uncertainty.from(graph, 0)[29]->trace(), open);
}

TEST(RelativeUncertainty, NothingIsKnownOfWhatNoLinkReaches) {
  Graph graph = chain(3);
  graph.nodes.push_back({3, {9.0, 9.0, 0.0}});
  RelativeUncertainty uncertainty;
  uncertainty.update(graph);
  const auto known = uncertainty.from(graph, 0);
  EXPECT_TRUE(known[2]);
  EXPECT_FALSE(known[3]);
}

TEST(RelativeUncertainty, BeginsAnewWithAnotherGraph) {
  RelativeUncertainty uncertainty;
  uncertainty.update(chain(30));
  const Graph small = chain(4);
  uncertainty.update(small);
  EXPECT_EQ(uncertainty.from(small, 0).size(), 4U);
  EXPECT_TRUE(uncertainty.from(small, 0)[3]);
}

}  // namespace
}  // namespace oort
