// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// A trajectory that was kidnapped once, and comes home by one closure (docs/optimiser.md).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "graph_scenes.hpp"
#include "oort/graph/optimizer.hpp"

namespace oort {
namespace {

// Variances of the map that Mayfield's Oort saved.
const Eigen::Matrix3d kStep = Eigen::Vector3d(5e-3, 5e-3, 2.5e-2).asDiagonal();
const Eigen::Matrix3d kDock = Eigen::Vector3d(1.5e-4, 1.5e-4, 1e-3).asDiagonal();

/// A drive whose edges say, at one of them, something else than where the robot went, and a closure from its first
/// node to its last that knows better.
Graph kidnapped_graph(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  const auto count = std::uniform_int_distribution<std::uint64_t>(40, 300)(random);
  const auto kidnapped = std::uniform_int_distribution<std::uint64_t>(count / 4, 3 * count / 4)(random);
  Pose2 truth;
  Graph graph;
  graph.nodes.push_back({0, truth});
  for (std::uint64_t k = 1; k < count; ++k) {
    const Pose2 step{0.2, 0.0, 0.3 * normal(random)};
    truth = truth * step;
    Pose2 measured{step.x + 0.015 * normal(random), step.y + 0.015 * normal(random),
                   step.theta + 0.03 * normal(random)};
    if (k == kidnapped) {
      measured.x += 1.5 * normal(random);
      measured.y += 1.5 * normal(random);
      measured.theta += normal(random);
    }
    graph.edges.push_back({k - 1, k - 1, k, {0.0, k, measured, kStep, ConstraintType::kLaser}});
    graph.nodes.push_back({k, graph.nodes.back().pose * measured});
  }
  graph.switchable_edges.push_back({count, 0, count - 1, {0.0, 0, truth, kDock, ConstraintType::kLaser}, 1.0});
  return graph;
}

/// What the graph costs where the closure is on, solved from where it is always believed.
double cost_with_closure(Graph graph) {
  OptimizerOptions options;
  options.max_iterations = 200;
  const SwitchableEdge closure = graph.switchable_edges.front();
  graph.switchable_edges.clear();
  graph.edges.push_back({closure.id, closure.i, closure.j, closure.constraint});
  optimize(graph, options);
  graph.edges.pop_back();
  graph.switchable_edges.push_back(closure);
  return optimize(graph, options).final_cost;
}

TEST(KidnappedGraph, AClosureIsOffOnlyWhereThatCostsLess) {
  int far = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    Graph graph = kidnapped_graph(seed);
    const double with_closure = cost_with_closure(graph);
    const OptimizerSummary solved = optimize(graph, {});
    EXPECT_LT(solved.final_cost, with_closure + 0.01) << "seed " << seed;
    if (with_closure < 0.9) ++far;
  }
  EXPECT_GT(far, 20) << "else nothing is shown";
}

TEST(KidnappedGraph, IsSolvedToTheSameBits) {
  Graph once = kidnapped_graph(3), twice = kidnapped_graph(3);
  optimize(once, {});
  optimize(twice, {});
  for (std::size_t k = 0; k < once.nodes.size(); ++k) {
    EXPECT_EQ(once.nodes[k].pose.x, twice.nodes[k].pose.x);
    EXPECT_EQ(once.nodes[k].pose.theta, twice.nodes[k].pose.theta);
  }
}

}  // namespace
}  // namespace oort
