// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/optimizer.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "oort/geometry/errors.hpp"
#include "oort/graph/graph_check.hpp"
#include "oort/graph/graph_solver.hpp"
#include "oort/graph/internal/residuals.hpp"
#include "oort/graph/landmarks.hpp"
#include "oort/graph/search.hpp"
#include "oort/graph/tuning.hpp"

namespace oort {
namespace {

// Squared errors beyond this overflow once products of them are summed.
constexpr double kLargestSquaredError = 1e100;

/// The edge as the solver takes it. InputError, naming the edge, if its covariance has no inverse or its error is too
/// large to compute with.
template <typename AnyEdge>
SolverEdge prepare(const AnyEdge& edge, const std::vector<Node>& nodes, Whitening whitening) {
  SolverEdge prepared;
  prepared.i = edge.i;
  prepared.j = edge.j;
  prepared.T_i_j = edge.constraint.T_i_j;
  try {
    prepared.W = whitening_matrix(edge.constraint.covariance, whitening);
  } catch (const InputError& error) {
    throw InputError(describe(edge) + ": " + error.what());
  }
  const Eigen::Vector3d error = constraint_error(nodes[edge.i].pose, nodes[edge.j].pose, prepared.T_i_j);
  if (!((prepared.W * error).squaredNorm() < kLargestSquaredError)) {
    throw InputError(describe(edge) + ": poses and measurement differ by far more standard deviations than can be" +
                     " squared; check their units");
  }
  return prepared;
}

/// The edges, then the switchable edges.
std::vector<SolverEdge> solver_edges(const Graph& graph, Whitening whitening) {
  std::vector<SolverEdge> edges;
  edges.reserve(graph.edges.size() + graph.switchable_edges.size());
  for (const Edge& edge : graph.edges) edges.push_back(prepare(edge, graph.nodes, whitening));
  for (const SwitchableEdge& edge : graph.switchable_edges) {
    edges.push_back(prepare(edge, graph.nodes, whitening));
    edges.back().switchable = true;
    edges.back().firmness = edge.firmness;
    edges.back().s = edge.switch_value;
  }
  return edges;
}

std::vector<int> variables_of(const Graph& graph, const OptimizerOptions& options) {
  const std::vector<bool> anchors = find_anchors(graph);
  std::vector<int> variables(graph.nodes.size(), -1);
  int count = 0;
  for (std::size_t k = 0; k < variables.size(); ++k) {
    if (!anchors[k] && !options.holds(k)) variables[k] = count++;
  }
  return variables;
}

std::vector<Pose2> poses_of(const Graph& graph) {
  std::vector<Pose2> poses;
  for (const Node& node : graph.nodes) poses.push_back(node.pose);
  return poses;
}

void write_back(const GraphSolver& solver, Graph& graph) {
  for (std::size_t k = 0; k < graph.nodes.size(); ++k) {
    if (solver.is_held(k)) continue;  // keeps its very bits
    const Pose2& pose = solver.poses()[k];
    graph.nodes[k].pose = {pose.x, pose.y, wrap_angle(pose.theta)};
  }
}

const char* describe(GraphSolver::Progress progress) {
  if (progress == GraphSolver::Progress::kConverged) return "converged";
  return progress == GraphSolver::Progress::kStuck ? "no step lowers the cost" : "reached the limit of iterations";
}

}  // namespace

void check_options(const OptimizerOptions& options) {
  if (!std::isfinite(options.switchable_constraint_scale) || options.switchable_constraint_scale <= 0.0) {
    throw ParameterError("switchable_constraint_scale must be above 0, not " +
                         std::to_string(options.switchable_constraint_scale));
  }
  if (!std::isfinite(options.huber_scale) || options.huber_scale <= 0.0) {
    throw ParameterError("huber_scale must be above 0, not " + std::to_string(options.huber_scale));
  }
  if (options.max_iterations < 1) {
    throw ParameterError("max_iterations must be at least 1, not " + std::to_string(options.max_iterations));
  }
}

OptimizerSummary optimize(Graph& graph, const OptimizerOptions& options) {
  if (options.robust_kernel == RobustKernel::kHuber) {
    Landmarks none;
    charge(options.meter, GraphTuning::kWorkPerHuberEdge *
                              static_cast<double>(graph.edges.size() + graph.switchable_edges.size()) *
                              options.max_iterations);
    return optimize_with_landmarks(graph, {}, none, options);
  }
  check_options(options);
  check_graph(graph);
  GraphSolver solver(poses_of(graph), variables_of(graph, options), solver_edges(graph, options.whitening),
                     options.switchable_constraint_scale);
  solver.set_meter(options.meter);
  OptimizerSummary summary;
  summary.initial_cost = robust_cost(solver);
  Search search(solver, options.max_iterations);
  search.run(options.decide);
  summary.converged = search.progress() == GraphSolver::Progress::kConverged;
  summary.iterations = search.iterations();
  summary.final_cost = robust_cost(solver);
  summary.message = describe(search.progress());
  write_back(solver, graph);
  for (std::size_t k = 0; k < graph.switchable_edges.size(); ++k) {
    const SolverEdge& edge = solver.edges()[graph.edges.size() + k];
    const double chi2 = solver.squared_error(edge);
    graph.switchable_edges[k].switch_value = solver.best_switch(edge, chi2);
    summary.chi_squared.push_back(chi2);
  }
  return summary;
}

}  // namespace oort
