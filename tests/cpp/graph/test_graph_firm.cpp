// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Links that cost more than others to switch off (docs/optimiser.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "graph_scenes.hpp"
#include "oort/geometry/errors.hpp"
#include "oort/graph/optimizer.hpp"

namespace oort {
namespace {

constexpr double kFirmness = 100.0;

SwitchableEdge firm(SwitchableEdge edge, double firmness) {
  edge.firmness = firmness;
  return edge;
}

/// A drive of four laps whose every step turns too far by more than its covariance admits.
Graph bent_graph(unsigned seed) {
  Graph graph = square_graph(4, seed);
  for (Edge& edge : graph.edges) {
    edge.constraint.T_i_j.theta += 0.005;
    graph.nodes[edge.j].pose = graph.nodes[edge.i].pose * edge.constraint.T_i_j;
  }
  return graph;
}

/// What is true of the first and the last node.
SwitchableEdge true_dock(const Graph& graph) {
  const std::vector<Pose2> truth = square_truth(4);
  return closure(500, 0, graph.nodes.back().id, between(truth.front(), truth.back()));
}

void add_false_closures(Graph& graph, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::uint64_t> node(0, graph.nodes.size() - 1);
  std::uniform_real_distribution<double> turn(1.0, 2.0);
  for (int k = 0; k < count;) {
    const std::uint64_t i = node(random), j = node(random);
    if (i == j || i % 16 == j % 16) continue;
    const std::uint64_t id = 1000 + static_cast<std::uint64_t>(k++);
    graph.switchable_edges.push_back(closure(id, std::max(i, j), std::min(i, j), {0.1, 0.1, turn(random)}));
  }
}

double worst_distance(const Graph& graph, const std::vector<Pose2>& poses) {
  double worst = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) worst = std::max(worst, distance(graph.nodes[k].pose, poses[k]));
  return worst;
}

std::vector<Pose2> poses_of(const Graph& graph) {
  std::vector<Pose2> poses;
  for (const Node& node : graph.nodes) poses.push_back(node.pose);
  return poses;
}

TEST(FirmLinks, BendAChainThatIsSureOfWhatIsWrong) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Graph bent = bent_graph(seed);
    Graph plain = bent, held = bent;
    plain.switchable_edges.push_back(true_dock(bent));
    held.switchable_edges.push_back(firm(true_dock(bent), kFirmness));
    ASSERT_TRUE(optimize(plain, {}).converged);
    ASSERT_TRUE(optimize(held, {}).converged);
    EXPECT_FALSE(plain.switchable_edges[0].is_on()) << seed;  // else there would be nothing to show
    EXPECT_GT(held.switchable_edges[0].switch_value, 0.9) << seed;
    EXPECT_LT(worst_distance(held, square_truth(4)), 0.5 * worst_distance(bent, square_truth(4))) << seed;
  }
}

TEST(FirmLinks, OutlastFalseClosures) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Graph graph = bent_graph(seed);
    graph.switchable_edges.push_back(firm(true_dock(graph), kFirmness));
    Graph alone = graph;
    add_false_closures(graph, 30, 100 + seed);
    ASSERT_TRUE(optimize(alone, {}).converged);
    ASSERT_TRUE(optimize(graph, {}).converged);
    EXPECT_GT(graph.switchable_edges[0].switch_value, 0.9) << seed;
    EXPECT_LT(worst_distance(graph, poses_of(alone)), 1e-3) << seed;
  }
}

TEST(FirmLinks, GoOffWhereTheWholeMapContradictsThem) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Graph graph = square_graph(4, seed);
    close_laps(graph, 4);
    Graph without = graph;
    graph.switchable_edges.push_back(firm(closure(900, 0, 60, {0.0, 0.0, 0.0}), kFirmness));
    graph.switchable_edges.push_back(firm(closure(901, 0, 55, {2.0, -1.0, 0.3}), kFirmness));
    ASSERT_TRUE(optimize(without, {}).converged);
    ASSERT_TRUE(optimize(graph, {}).converged);
    EXPECT_LT(graph.switchable_edges[48].switch_value, 0.01) << seed;
    EXPECT_LT(graph.switchable_edges[49].switch_value, 0.01) << seed;
    EXPECT_LT(worst_distance(graph, poses_of(without)), 1e-4) << seed;
  }
}

TEST(FirmLinks, StayAsTheyAreWhenSolvedAgain) {
  Graph graph = bent_graph(3);
  graph.switchable_edges.push_back(firm(true_dock(graph), kFirmness));
  ASSERT_TRUE(optimize(graph, {}).converged);
  const std::vector<Pose2> before = poses_of(graph);
  const OptimizerSummary again = optimize(graph, {});
  EXPECT_LE(again.iterations, 2);
  EXPECT_NEAR(again.final_cost, again.initial_cost, 1e-6 * again.initial_cost);
  EXPECT_LT(worst_distance(graph, before), 1e-5);
}

TEST(FirmLinks, CostAsTheySay) {
  Graph graph = bent_graph(5);
  graph.switchable_edges.push_back(firm(true_dock(graph), 30.0));
  OptimizerOptions options;
  options.switchable_constraint_scale = 3.0;
  const OptimizerSummary summary = optimize(graph, options);
  const double chi2 = summary.chi_squared.at(0);
  EXPECT_NEAR(graph.switchable_edges[0].switch_value, 90.0 / (90.0 + chi2), 1e-9);
  graph.switchable_edges[0].firmness = 1.0;
  Graph as_plain = graph;
  EXPECT_NEAR(optimize(as_plain, options).initial_cost - summary.final_cost,
              0.5 * chi2 * (3.0 / (3.0 + chi2) - 90.0 / (90.0 + chi2)), 1e-6);
}

TEST(FirmLinks, CannotBeLessThanOrdinary) {
  Graph graph = square_graph(1, 1);
  for (const double firmness : {0.5, 0.0, -1.0, std::nan("")}) {
    graph.switchable_edges = {firm(closure(1, 0, 12, {}), firmness)};
    EXPECT_THROW(optimize(graph, {}), InputError) << firmness;
  }
}

}  // namespace
}  // namespace oort
