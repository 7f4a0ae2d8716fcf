// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/optimizer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "oort/geometry/errors.hpp"
#include "oort/graph/graph_check.hpp"
#include "oort/graph/graph_solver.hpp"
#include "oort/graph/residuals.hpp"

namespace oort {
namespace {

// Squared errors beyond this overflow once products of them are summed.
constexpr double kLargestSquaredError = 1e100;

// A link agrees with a solution if its squared error is at most this: 95 % of a chi-square of 3 degrees of freedom.
constexpr double kAgreement = 7.815;

// A link that was on and is now farther off than this (99.9 %) says that the solution may be another one altogether.
constexpr double kSurprise = 16.266;

// While the solution is searched for, a link whose best switch is below this is left out: it hardly pulls, and false
// links, which join distant nodes, make each step dear.
constexpr double kOff = 0.01;

// How many steps are made before links that are off are left out; then before and between looking again which those
// are.
constexpr int kFirstSteps = 2;
constexpr int kSearchRounds = 3;
constexpr int kSearchSteps = 3;

// Blocks in the factor from which on a step is dear: then one start must do.
constexpr std::size_t kDear = 100'000;

// From this round of deciding on, links only leave, so that deciding ends.
constexpr int kRoundsBothWays = 10;

// Solving ends with a step that lowers the cost by less: it moves nothing by as much as a thousandth of its standard
// deviation, or, while the solution is searched for, a fifth.
constexpr double kTolerance = 1e-6;
constexpr double kSearchTolerance = 1e-2;

// Poses at which the links that are always believed cost less are those of the chain.
constexpr double kChained = 1e-3;

void check_options(const OptimizerOptions& options) {
  if (!std::isfinite(options.switchable_constraint_scale) || options.switchable_constraint_scale <= 0.0) {
    throw ParameterError("switchable_constraint_scale must be above 0, not " +
                         std::to_string(options.switchable_constraint_scale));
  }
  if (options.max_iterations < 1) {
    throw ParameterError("max_iterations must be at least 1, not " + std::to_string(options.max_iterations));
  }
}

/// The edge as a link. InputError, naming the edge, if its covariance has no inverse or its error is too large to
/// compute with.
template <typename AnyEdge>
Link link_of(const AnyEdge& edge, const std::vector<Node>& nodes, Whitening whitening) {
  Link link;
  link.i = edge.i;
  link.j = edge.j;
  link.T_i_j = edge.constraint.T_i_j;
  try {
    link.W = whitening_matrix(edge.constraint.covariance, whitening);
  } catch (const InputError& error) {
    throw InputError(describe(edge) + ": " + error.what());
  }
  const Eigen::Vector3d error = constraint_error(nodes[edge.i].pose, nodes[edge.j].pose, link.T_i_j);
  if (!((link.W * error).squaredNorm() < kLargestSquaredError)) {
    throw InputError(describe(edge) + ": poses and measurement differ by far more standard deviations than can be" +
                     " squared; check their units");
  }
  return link;
}

/// The edges, then the switchable edges.
std::vector<Link> links_of(const Graph& graph, Whitening whitening) {
  std::vector<Link> links;
  links.reserve(graph.edges.size() + graph.switchable_edges.size());
  for (const Edge& edge : graph.edges) links.push_back(link_of(edge, graph.nodes, whitening));
  for (const SwitchableEdge& edge : graph.switchable_edges) {
    links.push_back(link_of(edge, graph.nodes, whitening));
    links.back().switchable = true;
    links.back().s = edge.switch_value;
  }
  return links;
}

std::vector<int> variables_of(const Graph& graph, std::uint64_t first_free_node) {
  const std::vector<bool> anchors = find_anchors(graph);
  std::vector<int> variables(graph.nodes.size(), -1);
  int count = 0;
  for (std::size_t k = 0; k < variables.size(); ++k) {
    if (!anchors[k] && k >= first_free_node) variables[k] = count++;
  }
  return variables;
}

std::vector<Pose2> poses_of(const Graph& graph) {
  std::vector<Pose2> poses;
  for (const Node& node : graph.nodes) poses.push_back(node.pose);
  return poses;
}

double cost(const GraphSolver& solver) {
  double sum = 0.0;
  for (const Link& link : solver.links()) {
    const double chi2 = solver.squared_error(link);
    sum += link.switchable ? chi2 * solver.best_switch(chi2) : chi2;
  }
  return 0.5 * sum;
}

/// The part of the links that are always believed.
double believed_cost(const GraphSolver& solver) {
  double sum = 0.0;
  for (const Link& link : solver.links()) {
    if (!link.switchable) sum += solver.squared_error(link);
  }
  return 0.5 * sum;
}

/// The poses that follow from the links that are always believed alone: each node where the most certain of its links
/// to earlier nodes has it.
std::vector<Pose2> chained_poses(const GraphSolver& solver, const std::vector<int>& variables) {
  std::vector<Pose2> poses = solver.poses();
  std::vector<const Link*> best(poses.size(), nullptr);
  const auto certainty = [](const Link& link) { return std::abs(link.W.determinant()); };
  for (const Link& link : solver.links()) {
    const Link*& chosen = best[std::max(link.i, link.j)];
    if (!link.switchable && (chosen == nullptr || certainty(link) > certainty(*chosen))) chosen = &link;
  }
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (variables[k] < 0 || best[k] == nullptr) continue;
    const Link& link = *best[k];
    poses[k] = k == link.j ? poses[link.i] * link.T_i_j : poses[link.j] * inverse(link.T_i_j);
  }
  return poses;
}

/// The way to the solution.
///
/// If no link that was on surprises, all that is left to do is to decide anew which agree. Else what was believed may
/// be wrong: all switches start at 1 again, so that links that were off together can come back together; a solution
/// that costs more than the poses that were there is dropped.
class Search {
 public:
  Search(GraphSolver& solver, const std::vector<int>& variables, const OptimizerOptions& options)
      : solver_(solver), variables_(variables), options_(options) {}

  void run() {
    const bool surprised = is_surprised();
    if (surprised) {
      for (std::size_t k = 0; k < solver_.links().size(); ++k) solver_.set_switch(k, 1.0);
    }
    if (!options_.decide) {
      solve_switches(0.0, kTolerance, options_.max_iterations, options_.max_iterations);
      return;
    }
    if (surprised) search();
    const double agreeing_switch = solver_.best_switch(kAgreement);
    const auto agrees = [agreeing_switch](const Link& link, double chi2, int round) {
      if (round == 0 && link.s > agreeing_switch) return chi2 <= kSurprise;  // may pull before it is judged
      return chi2 <= kAgreement && (round < kRoundsBothWays || link.on);
    };
    settle(agrees, kTolerance, options_.max_iterations, options_.max_iterations);
  }

  int iterations() const { return iterations_; }
  GraphSolver::Progress progress() const { return progress_; }

 private:
  /// Whether a link that was on is far off at the poses as they are.
  bool is_surprised() const {
    const double agreeing_switch = solver_.best_switch(kAgreement);
    return std::any_of(solver_.links().begin(), solver_.links().end(), [&](const Link& link) {
      return link.switchable && link.s > agreeing_switch && solver_.squared_error(link) > kSurprise;
    });
  }

  /// With the links whose best switch is at least this, then with those that are not off.
  void solve_switches(double least_switch, double tolerance, int most_steps, int most_rounds) {
    std::vector<bool> on;
    for (const Link& link : solver_.links()) {
      on.push_back(!link.switchable || solver_.best_switch(solver_.squared_error(link)) >= least_switch);
    }
    solver_.use(on);
    is_dear_ = solver_.fill() >= kDear;
    converge(tolerance, kFirstSteps);
    const auto is_not_off = [this](const Link&, double chi2, int) { return solver_.best_switch(chi2) >= kOff; };
    settle(is_not_off, tolerance, most_steps, most_rounds);
  }

  /// From the poses as they are, and from those of the chain alone, which false links have not bent yet; then once
  /// more from the better ones, without the links that are off there, so that those in doubt get a second chance.
  void search() {
    std::vector<Pose2> best = solver_.poses();
    double least = cost(solver_);
    const auto try_from = [&](std::vector<Pose2> start, double least_switch) {
      solver_.set_poses(std::move(start));
      for (std::size_t k = 0; k < solver_.links().size(); ++k) solver_.set_switch(k, 1.0);
      solve_switches(least_switch, kSearchTolerance, kSearchSteps, kSearchRounds);
      if (const double reached = cost(solver_); reached < least) {
        least = reached;
        best = solver_.poses();
      }
    };
    std::vector<Pose2> chain = chained_poses(solver_, variables_);
    const bool is_chain = believed_cost(solver_) < kChained;
    try_from(best, 0.0);
    if (!is_chain && !is_dear_) try_from(std::move(chain), 0.0);
    try_from(best, kOff);
    solver_.set_poses(std::move(best));
  }

  /// Solves with the links that the rule chooses by their squared errors, again and again until they stay the same.
  template <typename Rule>
  void settle(const Rule& takes_part, double tolerance, int most_steps, int most_rounds) {
    for (int round = 0; round < most_rounds; ++round) {
      std::vector<bool> on;
      for (std::size_t k = 0; k < solver_.links().size(); ++k) {
        const Link& link = solver_.links()[k];
        const double chi2 = solver_.squared_error(link);
        on.push_back(!link.switchable || takes_part(link, chi2, round));
        if (link.switchable) solver_.set_switch(k, solver_.best_switch(chi2));
      }
      if (!solver_.use(on) && round > 0) return;
      converge(tolerance, most_steps);
    }
  }

  void converge(double tolerance, int most_steps) {
    progress_ = GraphSolver::Progress::kMoved;
    for (int k = 0; k < most_steps && iterations_ < options_.max_iterations; ++k) {
      progress_ = solver_.step(tolerance);
      ++iterations_;
      if (progress_ != GraphSolver::Progress::kMoved) return;
    }
  }

  GraphSolver& solver_;
  const std::vector<int>& variables_;
  const OptimizerOptions& options_;
  bool is_dear_ = false;
  int iterations_ = 0;
  GraphSolver::Progress progress_ = GraphSolver::Progress::kMoved;
};

void write_back(const GraphSolver& solver, const std::vector<int>& variables, Graph& graph) {
  for (std::size_t k = 0; k < graph.nodes.size(); ++k) {
    if (variables[k] < 0) continue;  // keeps its very bits
    const Pose2& pose = solver.poses()[k];
    graph.nodes[k].pose = {pose.x, pose.y, wrap_angle(pose.theta)};
  }
}

const char* describe(GraphSolver::Progress progress) {
  if (progress == GraphSolver::Progress::kConverged) return "converged";
  return progress == GraphSolver::Progress::kStuck ? "no step lowers the cost" : "reached the limit of iterations";
}

}  // namespace

OptimizerSummary optimize(Graph& graph, const OptimizerOptions& options) {
  check_options(options);
  check_graph(graph);
  const std::vector<int> variables = variables_of(graph, options.first_free_node);
  GraphSolver solver(poses_of(graph), variables, links_of(graph, options.whitening),
                     options.switchable_constraint_scale);
  OptimizerSummary summary;
  summary.initial_cost = cost(solver);
  Search search(solver, variables, options);
  search.run();
  summary.converged = search.progress() == GraphSolver::Progress::kConverged;
  summary.iterations = search.iterations();
  summary.final_cost = cost(solver);
  summary.message = describe(search.progress());
  write_back(solver, variables, graph);
  for (std::size_t k = 0; k < graph.switchable_edges.size(); ++k) {
    const double chi2 = solver.squared_error(solver.links()[graph.edges.size() + k]);
    graph.switchable_edges[k].switch_value = solver.best_switch(chi2);
    summary.chi_squared.push_back(chi2);
  }
  return summary;
}

}  // namespace oort
