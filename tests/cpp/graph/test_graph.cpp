// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "graph_scenes.hpp"
#include "oort/geometry/errors.hpp"
#include "oort/graph/optimizer.hpp"

namespace oort {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double chi_squared(const SwitchableEdge& edge, const Graph& graph) {
  const Pose2 T_i_j = between(graph.nodes[edge.i].pose, graph.nodes[edge.j].pose);
  const Eigen::Vector3d e(T_i_j.x - edge.constraint.T_i_j.x, T_i_j.y - edge.constraint.T_i_j.y,
                          wrap_angle(T_i_j.theta - edge.constraint.T_i_j.theta));
  return e.dot(edge.constraint.covariance.llt().solve(e));
}

void expect_same_bits(const Pose2& a, const Pose2& b) {
  EXPECT_EQ(0, std::memcmp(&a, &b, sizeof(Pose2)));
}

void expect_same_bits(const Graph& a, const Graph& b) {
  for (std::size_t k = 0; k < a.nodes.size(); ++k) expect_same_bits(a.nodes[k].pose, b.nodes[k].pose);
  for (std::size_t k = 0; k < a.switchable_edges.size(); ++k) {
    EXPECT_EQ(a.switchable_edges[k].switch_value, b.switchable_edges[k].switch_value);
  }
}

/// The message of the InputError that optimising throws; a failure, and "", if it throws none or changes the graph.
std::string input_error(Graph graph) {
  const Graph before = graph;
  try {
    optimize(graph, {});
  } catch (const InputError& error) {
    expect_same_bits(graph, before);
    return error.what();
  }
  ADD_FAILURE() << "no InputError";
  return "";
}

TEST(Optimizer, ClosesASquare) {
  Graph graph = square_graph(1, 1);
  graph.switchable_edges.push_back(closure(50, 15, 0, {1.0, 0.0, M_PI / 2.0}));
  const Pose2 first = graph.nodes[0].pose;
  const double open = distance(graph.nodes[15].pose * Pose2{1.0, 0.0, M_PI / 2.0}, first);
  const OptimizerSummary summary = optimize(graph, {});
  EXPECT_TRUE(summary.converged) << summary.message;
  EXPECT_LT(summary.final_cost, summary.initial_cost);
  EXPECT_GE(summary.iterations, 1);
  EXPECT_FALSE(summary.message.empty());
  EXPECT_LT(distance(graph.nodes[15].pose * Pose2{1.0, 0.0, M_PI / 2.0}, first), 0.2 * open);
  EXPECT_GT(graph.switchable_edges[0].switch_value, 0.9);
  EXPECT_EQ(0.0, distance(graph.nodes[0].pose, first));
}

TEST(Optimizer, RecoversThePosesFromAnExactGraph) {
  const std::vector<Pose2> truth = square_truth(2);
  Graph graph = square_graph(2, 3);
  for (Edge& edge : graph.edges) edge.constraint.T_i_j = between(truth[edge.i], truth[edge.j]);
  close_laps(graph, 2);
  ASSERT_TRUE(optimize(graph, {}).converged);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_LT(distance(graph.nodes[k].pose, truth[k]), 1e-7);
    EXPECT_NEAR(wrap_angle(graph.nodes[k].pose.theta - truth[k].theta), 0.0, 1e-7);
  }
}

TEST(Optimizer, SwitchesAFalseClosureOffAndKeepsTheGoodOnes) {
  Graph good = square_graph(2, 7);
  close_laps(good, 2);
  Graph spoilt = good;
  spoilt.switchable_edges.push_back(closure(900, 3, 12, {0.3, -0.2, 1.0}));
  ASSERT_TRUE(optimize(good, {}).converged);
  ASSERT_TRUE(optimize(spoilt, {}).converged);
  EXPECT_LT(spoilt.switchable_edges.back().switch_value, 0.001);
  for (std::size_t k = 0; k + 1 < spoilt.switchable_edges.size(); ++k) {
    EXPECT_GT(spoilt.switchable_edges[k].switch_value, 0.5);
  }
  for (std::size_t k = 0; k < good.nodes.size(); ++k) {
    EXPECT_LT(distance(spoilt.nodes[k].pose, good.nodes[k].pose), 1e-3);
  }
}

TEST(Optimizer, BelievesAChainEdgeThatItWouldSwitchOff) {
  Graph graph = square_graph(2, 7);
  graph.edges.push_back(chain_edge(900, 3, 12, {0.3, -0.2, 1.0}));
  ASSERT_TRUE(optimize(graph, {}).converged);
  EXPECT_LT(distance(graph.nodes[3].pose * Pose2{0.3, -0.2, 1.0}, graph.nodes[12].pose), 2.0);
}

// With the poses held, the switch is least-squares optimal at scale / (scale + chi^2).
TEST(Optimizer, SwitchOptimumIsTheClosedForm) {
  for (const double scale : {0.5, 2.0, 10.0}) {
    Graph graph = square_graph(2, 11);
    close_laps(graph, 2);
    graph.switchable_edges.push_back(closure(900, 3, 12, {0.3, -0.2, 1.0}));
    graph.switchable_edges.push_back(
        closure(901, 0, 4, between(graph.nodes[0].pose, graph.nodes[4].pose) * Pose2{0.01, 0.02, 0.0}));
    OptimizerOptions options;
    options.switchable_constraint_scale = scale;
    ASSERT_TRUE(optimize(graph, options).converged);
    for (const SwitchableEdge& edge : graph.switchable_edges) {
      EXPECT_NEAR(edge.switch_value, scale / (scale + chi_squared(edge, graph)), 1e-3);
    }
  }
}

TEST(Optimizer, HoldsTheFirstNodeOfEveryPart) {
  Graph graph = square_graph(1, 1);
  const std::size_t size = graph.nodes.size();
  for (std::size_t k = 0; k < size; ++k) graph.nodes.push_back({size + k, Pose2{30.0, 5.0, 1.0} * graph.nodes[k].pose});
  for (std::size_t k = 0; k + 1 < size; ++k) {
    graph.edges.push_back(chain_edge(50 + k, size + k, size + k + 1, graph.edges[k].constraint.T_i_j));
  }
  graph.nodes.push_back({2 * size, {7.0, 8.0, 0.5}});  // a part of one node
  for (const std::size_t start : {std::size_t{0}, size}) {
    graph.switchable_edges.push_back(closure(90 + start, start + 15, start, {1.0, 0.0, M_PI / 2.0}));
  }
  const Graph before = graph;
  ASSERT_TRUE(optimize(graph, {}).converged);
  for (const std::size_t k : {std::size_t{0}, size, 2 * size}) {
    expect_same_bits(graph.nodes[k].pose, before.nodes[k].pose);
  }
  for (std::size_t k = 0; k < size; ++k) {
    EXPECT_LT(distance(graph.nodes[size + k].pose, Pose2{30.0, 5.0, 1.0} * graph.nodes[k].pose), 1e-5);
  }
}

TEST(Optimizer, JoinsPartsThatOnlyAClosureLinks) {
  Graph graph;
  graph.nodes = {{0, {0.0, 0.0, 0.0}}, {1, {5.0, 5.0, 2.0}}};
  graph.switchable_edges = {closure(0, 0, 1, {5.1, 4.9, 2.1})};
  ASSERT_TRUE(optimize(graph, {}).converged);
  EXPECT_LT(distance(graph.nodes[1].pose, {5.1, 4.9, 2.1}), 1e-4);
}

TEST(Optimizer, SameGraphGivesTheSameBits) {
  Graph graph = square_graph(4, 5);
  close_laps(graph, 4);
  graph.switchable_edges.push_back(closure(900, 3, 12, {0.3, -0.2, 1.0}));
  Graph again = graph;
  optimize(graph, {});
  optimize(again, {});
  expect_same_bits(graph, again);
}

TEST(Optimizer, StartsWhereTheLastSolveEnded) {
  Graph graph = square_graph(2, 5);
  close_laps(graph, 2);
  graph.switchable_edges.push_back(closure(900, 3, 12, {0.3, -0.2, 1.0}));
  const OptimizerSummary first = optimize(graph, {});
  const OptimizerSummary second = optimize(graph, {});
  EXPECT_NEAR(second.initial_cost, first.final_cost, 1e-9 * first.final_cost);
  EXPECT_LE(second.iterations, 1);
}

TEST(Optimizer, StopsAtTheIterationLimitWithTheBestSoFar) {
  Graph graph = square_graph(4, 5);
  close_laps(graph, 4);
  OptimizerOptions options;
  options.max_iterations = 1;
  const OptimizerSummary summary = optimize(graph, options);
  EXPECT_FALSE(summary.converged);
  EXPECT_LT(summary.final_cost, summary.initial_cost);
}

TEST(Optimizer, WrapsAtPi) {
  Graph graph;
  graph.nodes = {{0, {0.0, 0.0, 3.0}}, {1, {0.0, 0.0, 3.1}}, {2, {0.0, 0.0, -3.1}}};
  graph.edges = {chain_edge(0, 0, 1, {0.0, 0.0, 0.12}), chain_edge(1, 1, 2, {0.0, 0.0, 0.06})};
  const OptimizerSummary summary = optimize(graph, {});
  ASSERT_TRUE(summary.converged);
  EXPECT_LT(summary.initial_cost, 100.0);  // the errors are of some 0.02 rad, not of a turn
  EXPECT_NEAR(graph.nodes[1].pose.theta, 3.12, 1e-9);
  EXPECT_NEAR(graph.nodes[2].pose.theta, 3.18 - 2.0 * M_PI, 1e-9);
}

TEST(Optimizer, GraphWithoutEdgesIsSolved) {
  Graph graph;
  EXPECT_TRUE(optimize(graph, {}).converged);
  graph.nodes = {{0, {1.0, 2.0, 0.5}}};
  EXPECT_TRUE(optimize(graph, {}).converged);
  EXPECT_EQ(1.0, graph.nodes[0].pose.x);
}

TEST(Optimizer, NamesTheEdgeThatCannotBeUsed) {
  Graph graph = square_graph(1, 1);
  graph.edges[5].j = 99;
  EXPECT_NE(input_error(graph).find("edge 5 (node 5 to 99)"), std::string::npos);
  graph = square_graph(1, 1);
  graph.edges[5].j = 5;
  EXPECT_NE(input_error(graph).find("edge 5 (node 5 to 5) links a node to itself"), std::string::npos);
  graph = square_graph(1, 1);
  graph.edges[4].constraint.T_i_j.y = kNan;
  EXPECT_NE(input_error(graph).find("edge 4"), std::string::npos);
  graph = square_graph(1, 1);
  graph.nodes[3].pose.theta = kInfinity;
  EXPECT_NE(input_error(graph).find("node 3"), std::string::npos);
  graph = square_graph(1, 1);
  graph.nodes[3].id = 7;
  EXPECT_NE(input_error(graph).find("node 7 at position 3"), std::string::npos);
  graph = square_graph(1, 1);
  graph.switchable_edges = {closure(70, 0, 8, {})};
  graph.switchable_edges[0].switch_value = 1.5;
  EXPECT_NE(input_error(graph).find("edge 70"), std::string::npos);
}

TEST(Optimizer, RefusesCovariancesThatAreNone) {
  const auto message = [](const Eigen::Matrix3d& covariance) {
    Graph graph = square_graph(1, 1);
    graph.edges[2].constraint.covariance = covariance;
    return input_error(graph);
  };
  EXPECT_NE(message(Eigen::Matrix3d::Zero()).find("edge 2 (node 2 to 3): covariance"), std::string::npos);
  EXPECT_NE(message(-kCovariance).find("not positive definite"), std::string::npos);
  EXPECT_NE(message(Eigen::Matrix3d::Constant(kNan)).find("not finite"), std::string::npos);
  EXPECT_NE(message(Eigen::Vector3d(1.0, 1.0, 1e-320).asDiagonal()).find("edge 2"), std::string::npos);
  Eigen::Matrix3d skew = kCovariance;
  skew(0, 1) = 1e-5;
  EXPECT_NE(message(skew).find("not symmetric"), std::string::npos);
}

TEST(Optimizer, RefusesUnusableOptions) {
  Graph graph = square_graph(1, 1);
  OptimizerOptions options;
  options.switchable_constraint_scale = 0.0;
  EXPECT_THROW(optimize(graph, options), ParameterError);
  options.switchable_constraint_scale = kNan;
  EXPECT_THROW(optimize(graph, options), ParameterError);
  options = {};
  options.max_iterations = 0;
  EXPECT_THROW(optimize(graph, options), ParameterError);
}

TEST(Optimizer, RefusesErrorsThatCannotBeSquaredAndWritesNoLog) {
  Graph far = square_graph(1, 1);
  far.nodes[3].pose.x = 1e200;
  Graph sharp = square_graph(1, 1);
  sharp.edges[3].constraint.T_i_j.x = 1e10;
  sharp.edges[3].constraint.covariance *= 1e-294;
  testing::internal::CaptureStderr();
  EXPECT_NE(input_error(far).find("edge 2 (node 2 to 3)"), std::string::npos);
  EXPECT_NE(input_error(sharp).find("edge 3 (node 3 to 4)"), std::string::npos);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Optimizer, SolvesABadlyScaledGraph) {
  Graph graph = square_graph(2, 1);
  close_laps(graph, 2);
  for (Edge& edge : graph.edges) edge.constraint.covariance *= 1e-12;
  for (SwitchableEdge& edge : graph.switchable_edges) edge.constraint.covariance *= 1e12;
  testing::internal::CaptureStderr();
  EXPECT_TRUE(optimize(graph, {}).converged);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace oort
