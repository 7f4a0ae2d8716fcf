// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

#include "ceres_graph.hpp"
#include "graph_scenes.hpp"
#include "oort/graph/optimizer.hpp"

namespace oort {
namespace {

constexpr double kAgreement = 7.815;  // 95 % of a chi-square of 3 degrees of freedom

/// Closes the laps with errors of so many standard deviations in x, y and theta.
void close_laps_with_noise(Graph& graph, int laps, double sigmas, unsigned seed) {
  close_laps(graph, laps);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, sigmas);
  for (SwitchableEdge& edge : graph.switchable_edges) {
    Pose2& T_i_j = edge.constraint.T_i_j;
    T_i_j.x += 1e-2 * noise(random);
    T_i_j.y += 1e-2 * noise(random);
    T_i_j.theta += std::sqrt(1e-5) * noise(random);
  }
}

/// Closures between random nodes that claim them to be at the same place.
void add_false_closures(Graph& graph, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::uint64_t> node(0, graph.nodes.size() - 1);
  std::uniform_real_distribution<double> turn(1.0, 2.0);  // from what is true on the square: a multiple of pi / 2
  for (int k = 0; k < count;) {
    const std::uint64_t i = node(random), j = node(random);
    if (i == j || (i % 16) == (j % 16)) continue;
    graph.switchable_edges.push_back(closure(1000 + static_cast<std::uint64_t>(k++), i, j, {0.1, 0.1, turn(random)}));
  }
}

double worst_distance(const Graph& a, const Graph& b) {
  double worst = 0.0;
  for (std::size_t k = 0; k < a.nodes.size(); ++k) {
    worst = std::max(worst, distance(a.nodes[k].pose, b.nodes[k].pose));
    worst = std::max(worst, std::abs(wrap_angle(a.nodes[k].pose.theta - b.nodes[k].pose.theta)));
  }
  return worst;
}

double chi_squared(const SwitchableEdge& edge, const Graph& graph) {
  const Pose2 T_i_j = between(graph.nodes[edge.i].pose, graph.nodes[edge.j].pose);
  const Eigen::Vector3d e(T_i_j.x - edge.constraint.T_i_j.x, T_i_j.y - edge.constraint.T_i_j.y,
                          wrap_angle(T_i_j.theta - edge.constraint.T_i_j.theta));
  return e.dot(edge.constraint.covariance.llt().solve(e));
}

TEST(RobustOptimizer, WithoutADecisionFindsTheOptimumThatCeresFinds) {
  for (const double scale : {2.0, 4.0}) {
    Graph graph = square_graph(4, 21);
    close_laps_with_noise(graph, 4, 1.5, 22);
    Graph reference = graph;
    OptimizerOptions options;
    options.switchable_constraint_scale = scale;
    options.decide = false;
    options.max_iterations = 200;
    const OptimizerSummary summary = optimize(graph, options);
    ASSERT_TRUE(summary.converged) << summary.message;
    solve_with_ceres(reference, scale);
    // The optimum is flat where a switch is about to go either way, so poses tell less than the cost.
    EXPECT_LT(worst_distance(graph, reference), 5e-4);
    double least = 1.0;
    for (std::size_t k = 0; k < graph.switchable_edges.size(); ++k) {
      const double s = graph.switchable_edges[k].switch_value;
      EXPECT_NEAR(s, reference.switchable_edges[k].switch_value, 2e-2);
      least = std::min(least, s);
    }
    EXPECT_LT(least, 0.5);  // else there would be nothing to compare
    EXPECT_NEAR(summary.final_cost, optimize(reference, options).initial_cost, 1e-5 * summary.final_cost);
  }
}

TEST(RobustOptimizer, FalseClosuresPullNoMoreOnceTheyAreLeftOut) {
  Graph graph = square_graph(4, 21);
  close_laps_with_noise(graph, 4, 0.5, 23);
  Graph clean = graph;
  add_false_closures(graph, 40, 24);
  const OptimizerSummary summary = optimize(graph, {});
  ASSERT_TRUE(summary.converged);
  solve_with_ceres(clean, OptimizerOptions{}.switchable_constraint_scale);
  EXPECT_LT(worst_distance(graph, clean), 1e-4);
  for (std::size_t k = 0; k < graph.switchable_edges.size(); ++k) {
    EXPECT_EQ(summary.chi_squared[k] <= kAgreement, k < clean.switchable_edges.size()) << k;
  }
}

TEST(RobustOptimizer, WithstandsMoreFalseClosuresThanTrueOnes) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const double scale : {2.0, 4.0}) {
      OptimizerOptions options;
      options.switchable_constraint_scale = scale;
      Graph graph = square_graph(6, 30 + seed);
      close_laps_with_noise(graph, 6, 0.3, 50 + seed);
      Graph clean = graph;
      add_false_closures(graph, 200, 70 + seed);
      ASSERT_TRUE(optimize(graph, options).converged);
      ASSERT_TRUE(optimize(clean, options).converged);
      EXPECT_LT(worst_distance(graph, clean), 1e-4) << seed << " " << scale;
    }
  }
}

TEST(RobustOptimizer, SolvesInSeveralThreadsAtOnceGiveTheSameBits) {
  Graph graph = square_graph(6, 30);
  close_laps_with_noise(graph, 6, 0.3, 50);
  add_false_closures(graph, 150, 70);
  std::vector<Graph> solved(4, graph);
  std::vector<std::thread> threads;
  for (Graph& one : solved) threads.emplace_back([&one] { optimize(one, {}); });
  for (std::thread& thread : threads) thread.join();
  optimize(graph, {});
  for (const Graph& one : solved) {
    for (std::size_t k = 0; k < graph.nodes.size(); ++k) {
      EXPECT_EQ(0, std::memcmp(&one.nodes[k].pose, &graph.nodes[k].pose, sizeof(Pose2)));
    }
    for (std::size_t k = 0; k < graph.switchable_edges.size(); ++k) {
      EXPECT_EQ(one.switchable_edges[k].switch_value, graph.switchable_edges[k].switch_value);
    }
  }
}

TEST(RobustOptimizer, LinksThatWereOffTogetherComeBackTogether) {
  Graph graph = square_graph(2, 7);
  const double scale = OptimizerOptions{}.switchable_constraint_scale;
  // The second lap has left its place by more than one of its closures alone can move it.
  for (std::size_t k = 16; k < 32; ++k) graph.nodes[k].pose = Pose2{0.0, 0.15, 0.0} * graph.nodes[k].pose;
  graph.edges[15].constraint.T_i_j = between(graph.nodes[15].pose, graph.nodes[16].pose);
  close_laps(graph, 2);
  for (SwitchableEdge& edge : graph.switchable_edges) {
    edge.switch_value = scale / (scale + chi_squared(edge, graph));
    EXPECT_LT(edge.switch_value, 0.02);
  }
  Graph waiting = graph;
  ASSERT_TRUE(optimize(waiting, {}).converged);  // nothing new: they stay off
  EXPECT_LT(waiting.switchable_edges[8].switch_value, 0.02);

  graph.switchable_edges.back().switch_value = 1.0;  // as if it were new
  ASSERT_TRUE(optimize(graph, {}).converged);
  for (const SwitchableEdge& edge : graph.switchable_edges) EXPECT_GT(edge.switch_value, 0.4);
}

TEST(RobustOptimizer, AClosureThatCostsMoreThanItIsWorthMovesNothing) {
  Graph graph = square_graph(2, 7);
  close_laps(graph, 2);
  ASSERT_TRUE(optimize(graph, {}).converged);
  const Graph before = graph;
  graph.switchable_edges.push_back(closure(900, 3, 12, {0.3, -0.2, 1.0}));
  const OptimizerSummary summary = optimize(graph, {});
  EXPECT_TRUE(summary.converged);
  EXPECT_LE(summary.final_cost, summary.initial_cost * (1.0 + 1e-6));
  EXPECT_LT(worst_distance(graph, before), 1e-4);
  EXPECT_LT(graph.switchable_edges.back().switch_value, 0.01);
}

TEST(RobustOptimizer, TellsHowEachLinkAgrees) {
  Graph graph = square_graph(3, 5);
  close_laps_with_noise(graph, 3, 1.0, 6);
  add_false_closures(graph, 5, 7);
  OptimizerOptions options;
  options.switchable_constraint_scale = 3.0;
  const OptimizerSummary summary = optimize(graph, options);
  ASSERT_EQ(summary.chi_squared.size(), graph.switchable_edges.size());
  for (std::size_t k = 0; k < summary.chi_squared.size(); ++k) {
    const double chi2 = chi_squared(graph.switchable_edges[k], graph);
    EXPECT_NEAR(summary.chi_squared[k], chi2, 1e-6 * (1.0 + chi2));
    EXPECT_NEAR(graph.switchable_edges[k].switch_value, 3.0 / (3.0 + chi2), 1e-6);
  }
}

TEST(RobustOptimizer, NodesBeforeTheFirstFreeKeepTheirBits) {
  Graph graph = square_graph(3, 5);
  close_laps_with_noise(graph, 3, 0.5, 6);
  ASSERT_TRUE(optimize(graph, {}).converged);
  const Graph whole = graph;
  for (std::size_t k = 40; k < graph.nodes.size(); ++k) {
    graph.nodes[k].pose = graph.nodes[k - 1].pose * graph.edges[k - 1].constraint.T_i_j;  // as they came, by odometry
  }
  const double off_before = worst_distance(graph, whole);
  OptimizerOptions options;
  options.first_free_node = 40;
  ASSERT_TRUE(optimize(graph, options).converged);
  for (std::size_t k = 0; k < 40; ++k) {
    EXPECT_EQ(0, std::memcmp(&graph.nodes[k].pose, &whole.nodes[k].pose, sizeof(Pose2)));
  }
  EXPECT_GT(off_before, 1e-3);
  EXPECT_LT(worst_distance(graph, whole), 1e-4);  // the rest is where the whole graph's optimum has it
}

/// A round of a kilometre in steps of 0.25 m, each of which turns a little too far: it ends some metres off, well
/// within what its covariances admit. Each node sees the one ten before, bent alike; the last ten see the first ten.
Graph long_round() {
  const std::uint64_t size = 4000;
  const Eigen::Matrix3d step = Eigen::Vector3d(0.02, 0.02, 0.008).cwiseAbs2().asDiagonal();
  const Eigen::Matrix3d seen = Eigen::Vector3d(0.05, 0.05, 0.015).cwiseAbs2().asDiagonal();
  Graph graph;
  std::vector<Pose2> truth{Pose2{}};
  graph.nodes.push_back({0, truth[0]});
  for (std::uint64_t k = 1; k < size; ++k) {
    const Pose2 T_before_after{0.25, 0.0, k % (size / 4) == 0 ? M_PI / 2.0 : 0.0};
    truth.push_back(truth.back() * T_before_after);
    Edge edge = chain_edge(k - 1, k - 1, k, T_before_after * Pose2{0.0, 0.0, 3e-5});
    edge.constraint.covariance = step;
    graph.nodes.push_back({k, graph.nodes.back().pose * edge.constraint.T_i_j});
    graph.edges.push_back(edge);
    if (k < 10) continue;
    const Pose2 T_k_earlier = between(graph.nodes[k].pose, graph.nodes[k - 10].pose);
    graph.switchable_edges.push_back(closure(2 * size + k, k, k - 10, T_k_earlier));
    graph.switchable_edges.back().constraint.covariance = seen;
  }
  for (std::uint64_t k = 0; k < 10; ++k) {
    graph.switchable_edges.push_back(closure(size + k, size - 10 + k, k, between(truth[size - 10 + k], truth[k])));
    graph.switchable_edges.back().constraint.covariance = seen;
  }
  return graph;
}

TEST(RobustOptimizer, ClosesALongRoundInOneSolve) {
  Graph graph = long_round();
  ASSERT_GT(distance(graph.nodes.back().pose, graph.nodes.front().pose), 5.0);
  OptimizerOptions options;
  options.switchable_constraint_scale = 4.0;
  options.max_iterations = 15;  // as while mapping
  const OptimizerSummary summary = optimize(graph, options);
  for (const double chi2 : summary.chi_squared) EXPECT_LT(chi2, 1.0);
  EXPECT_LT(summary.final_cost, 1.0);
}

TEST(RobustOptimizer, WithNoFreeNodeOnlySwitchesAreSet) {
  Graph graph = square_graph(2, 5);
  close_laps(graph, 2);
  const Graph before = graph;
  OptimizerOptions options;
  options.first_free_node = graph.nodes.size();
  EXPECT_TRUE(optimize(graph, options).converged);
  EXPECT_EQ(worst_distance(graph, before), 0.0);
  EXPECT_LT(graph.switchable_edges[10].switch_value, 1.0);
}

}  // namespace
}  // namespace oort
