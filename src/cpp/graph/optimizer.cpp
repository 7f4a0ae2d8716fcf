// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/optimizer.hpp"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "oort/geometry/errors.hpp"
#include "oort/graph/residuals.hpp"

namespace oort {
namespace {

// A weak initial damping: graphs start near their optimum, where Gauss-Newton steps are right. Ceres's own 1e4 takes
// twice the iterations (Manhattan 3500); from 1e8 on, false closures make the first steps fail.
constexpr double kInitialTrustRegionRadius = 1e6;

// Squared errors beyond this overflow once products of them are summed.
constexpr double kLargestSquaredError = 1e100;

/// What Ceres varies, in the order of the graph's nodes and switchable edges.
struct Variables {
  std::vector<std::array<double, 3>> poses;
  std::vector<double> switches;
};

template <typename AnyEdge>
std::string describe(const AnyEdge& edge) {
  return "edge " + std::to_string(edge.id) + " (node " + std::to_string(edge.i) + " to " + std::to_string(edge.j) + ")";
}

void check_options(const OptimizerOptions& options) {
  if (!std::isfinite(options.switchable_constraint_scale) || options.switchable_constraint_scale <= 0.0) {
    throw ParameterError("switchable_constraint_scale must be above 0, not " +
                         std::to_string(options.switchable_constraint_scale));
  }
  if (options.max_iterations < 1) {
    throw ParameterError("max_iterations must be at least 1, not " + std::to_string(options.max_iterations));
  }
}

void check_nodes(const std::vector<Node>& nodes) {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (nodes[k].id != k) {
      throw InputError("node ids must count up from 0: found node " + std::to_string(nodes[k].id) + " at position " +
                       std::to_string(k));
    }
    if (!is_finite(nodes[k].pose)) throw InputError("the pose of node " + std::to_string(k) + " is not finite");
  }
}

template <typename AnyEdge>
void check_edge(const AnyEdge& edge, std::size_t node_count) {
  for (const std::uint64_t end : {edge.i, edge.j}) {
    if (end >= node_count) {
      throw InputError(describe(edge) + " names a node that is not in the graph, which has " +
                       std::to_string(node_count) + " nodes");
    }
  }
  if (edge.i == edge.j) throw InputError(describe(edge) + " links a node to itself");
  if (!is_finite(edge.constraint.T_i_j)) throw InputError("the measurement of " + describe(edge) + " is not finite");
}

void check_graph(const Graph& graph) {
  check_nodes(graph.nodes);
  for (const Edge& edge : graph.edges) check_edge(edge, graph.nodes.size());
  for (const SwitchableEdge& edge : graph.switchable_edges) {
    check_edge(edge, graph.nodes.size());
    if (!(edge.switch_value >= 0.0 && edge.switch_value <= 1.0)) {
      throw InputError("the switch of " + describe(edge) + " is " + std::to_string(edge.switch_value) +
                       ", outside 0 to 1");
    }
  }
}

/// One flag per node: true for the first node of each connected part. Without it the part could float freely.
std::vector<bool> find_anchors(const Graph& graph) {
  std::vector<std::size_t> parent(graph.nodes.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&parent](std::size_t k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  const auto join = [&parent, &root](std::size_t i, std::size_t j) {
    const auto [first, second] = std::minmax({root(i), root(j)});
    parent[second] = first;  // the root of a part is its first node
  };
  for (const Edge& edge : graph.edges) join(edge.i, edge.j);
  for (const SwitchableEdge& edge : graph.switchable_edges) join(edge.i, edge.j);

  std::vector<bool> anchors(graph.nodes.size());
  for (std::size_t k = 0; k < anchors.size(); ++k) anchors[k] = root(k) == k;
  return anchors;
}

Variables read_variables(const Graph& graph) {
  Variables variables;
  variables.poses.reserve(graph.nodes.size());
  for (const Node& node : graph.nodes) variables.poses.push_back({node.pose.x, node.pose.y, node.pose.theta});
  variables.switches.reserve(graph.switchable_edges.size());
  for (const SwitchableEdge& edge : graph.switchable_edges) variables.switches.push_back(edge.switch_value);
  return variables;
}

/// The edge's whitening matrix. InputError, naming the edge, if it has none or if its error is too large to compute
/// with: Ceres would then fail after writing to the log of the process.
template <typename AnyEdge>
Eigen::Matrix3d edge_whitening(const AnyEdge& edge, const std::vector<Node>& nodes, Whitening whitening) {
  Eigen::Matrix3d W;
  try {
    W = whitening_matrix(edge.constraint.covariance, whitening);
  } catch (const InputError& error) {
    throw InputError(describe(edge) + ": " + error.what());
  }
  const Eigen::Vector3d error = constraint_error(nodes[edge.i].pose, nodes[edge.j].pose, edge.constraint.T_i_j);
  if (!((W * error).squaredNorm() < kLargestSquaredError)) {
    throw InputError(describe(edge) + ": poses and measurement differ by far more standard deviations than can be" +
                     " squared; check their units");
  }
  return W;
}

/// Adds everything in the order of the graph: Ceres's own ordering, and with it the last bits, follow from it.
void build_problem(const Graph& graph, const OptimizerOptions& options, Variables& variables, ceres::Problem& problem) {
  const std::vector<bool> anchors = find_anchors(graph);
  for (std::size_t k = 0; k < variables.poses.size(); ++k) {
    problem.AddParameterBlock(variables.poses[k].data(), 3);
    if (anchors[k]) problem.SetParameterBlockConstant(variables.poses[k].data());
  }
  for (const Edge& edge : graph.edges) {
    const Eigen::Matrix3d W = edge_whitening(edge, graph.nodes, options.whitening);
    problem.AddResidualBlock(new ChainResidual(edge.constraint.T_i_j, W), nullptr, variables.poses[edge.i].data(),
                             variables.poses[edge.j].data());
  }
  for (std::size_t k = 0; k < graph.switchable_edges.size(); ++k) {
    const SwitchableEdge& edge = graph.switchable_edges[k];
    const Eigen::Matrix3d W = edge_whitening(edge, graph.nodes, options.whitening);
    double* const s = &variables.switches[k];
    problem.AddResidualBlock(new SwitchableResidual(edge.constraint.T_i_j, W), nullptr, variables.poses[edge.i].data(),
                             variables.poses[edge.j].data(), s);
    problem.AddResidualBlock(new SwitchPrior(options.switchable_constraint_scale), nullptr, s);
  }
}

ceres::Solver::Options solver_options(const OptimizerOptions& options) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // Not SuiteSparse: it may use several threads and whatever BLAS is installed, and both may change the last bits. On
  // the graphs of homes Eigen's factorisation is the faster one too.
  solver.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  solver.max_num_iterations = options.max_iterations;
  solver.initial_trust_region_radius = kInitialTrustRegionRadius;
  return solver;
}

void write_back(const Variables& variables, Graph& graph) {
  const std::vector<bool> anchors = find_anchors(graph);
  for (std::size_t k = 0; k < graph.nodes.size(); ++k) {
    if (anchors[k]) continue;  // keeps its very bits
    const auto& [x, y, theta] = variables.poses[k];
    graph.nodes[k].pose = {x, y, wrap_angle(theta)};
  }
  for (std::size_t k = 0; k < graph.switchable_edges.size(); ++k) {
    // Its optimum lies inside [0, 1] (SwitchPrior), but the solver stops just short of it, on either side.
    graph.switchable_edges[k].switch_value = std::clamp(variables.switches[k], 0.0, 1.0);
  }
}

}  // namespace

OptimizerSummary optimize(Graph& graph, const OptimizerOptions& options) {
  check_options(options);
  check_graph(graph);
  Variables variables = read_variables(graph);
  ceres::Problem::Options problem_options;
  problem_options.disable_all_safety_checks = true;  // check_graph has done them; they cost as much as the building
  ceres::Problem problem(problem_options);
  build_problem(graph, options, variables, problem);

  ceres::Solver::Summary solver_summary;
  ceres::Solve(solver_options(options), &problem, &solver_summary);
  if (solver_summary.IsSolutionUsable()) write_back(variables, graph);

  OptimizerSummary summary;
  summary.converged = solver_summary.termination_type == ceres::CONVERGENCE;
  summary.iterations = std::max(0, static_cast<int>(solver_summary.iterations.size()) - 1);
  summary.initial_cost = solver_summary.initial_cost;
  summary.final_cost = solver_summary.final_cost;
  summary.message = solver_summary.message;
  return summary;
}

}  // namespace oort
