// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/landmarks.hpp"

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <string>

#include "oort/geometry/errors.hpp"
#include "oort/graph/graph_check.hpp"
#include "oort/graph/internal/graph_costs.hpp"

namespace oort {
namespace {

using Block = std::array<double, 3>;

// Farther off, squares of errors overflow.
constexpr double kMaxCoordinate = 1e9;  // [m]

Block block_of(const Pose2& pose) {
  return {pose.x, pose.y, pose.theta};
}

Pose2 pose_of(const Block& block) {
  return {block[0], block[1], wrap_angle(block[2])};
}

void check_observation(const LandmarkObservation& observation, std::size_t number, std::size_t nodes) {
  const auto refuse = [number](const std::string& why) {
    throw InputError("landmark observation " + std::to_string(number) + ": " + why);
  };
  if (observation.before >= nodes || observation.after >= nodes) refuse("it names a node that the graph does not have");
  if (!(observation.fraction >= 0.0 && observation.fraction <= 1.0)) refuse("its fraction must lie in [0, 1]");
  const Pose2& pose = observation.T_sensor_landmark;
  if (!is_finite(pose) || std::max(std::abs(pose.x), std::abs(pose.y)) > kMaxCoordinate) {
    refuse("its pose is not finite or too far off");
  }
}

Eigen::Matrix3d whitening_or_throw(const Eigen::Matrix3d& covariance, Whitening whitening, const std::string& whose) {
  try {
    return whitening_matrix(covariance, whitening);
  } catch (const InputError& error) {
    throw InputError(whose + ": " + error.what());
  }
}

/// The graph as a problem for Ceres.
class HuberProblem {
 public:
  HuberProblem(const Graph& graph, const OptimizerOptions& options)
      : options_(options), loss_(options.huber_scale), problem_(borrowing()) {
    for (const Node& node : graph.nodes) nodes_.push_back(block_of(node.pose));  // before anything points there
    for (const Edge& edge : graph.edges) add_edge(edge, nullptr);
    for (const SwitchableEdge& edge : graph.switchable_edges) add_edge(edge, loss_of(edge));
    const std::vector<bool> anchors = find_anchors(graph);
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      problem_.AddParameterBlock(nodes_[k].data(), 3);
      if (anchors[k] || options.holds(k)) problem_.SetParameterBlockConstant(nodes_[k].data());
    }
  }

  void add(const std::vector<LandmarkObservation>& observations, const Landmarks& landmarks) {
    for (const auto& [id, pose] : landmarks) landmarks_[id] = block_of(pose);
    for (std::size_t k = 0; k < observations.size(); ++k) {
      const LandmarkObservation& o = observations[k];
      check_observation(o, k, nodes_.size());
      const Pose2 sensor = interpolate(pose_of(nodes_[o.before]), pose_of(nodes_[o.after]), o.fraction);
      Block& landmark = landmarks_.try_emplace(o.landmark, block_of(sensor * o.T_sensor_landmark)).first->second;
      const Eigen::Matrix3d W =
          whitening_or_throw(o.covariance, options_.whitening, "landmark observation " + std::to_string(k));
      add_observation(o, W, landmark);
    }
  }

  ceres::Solver::Summary solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = options_.max_iterations;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    return summary;
  }

  void write_back(Graph& graph, Landmarks& landmarks) const {
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      if (!problem_.IsParameterBlockConstant(nodes_[k].data())) graph.nodes[k].pose = pose_of(nodes_[k]);
    }
    for (const auto& [id, block] : landmarks_) landmarks[id] = pose_of(block);
  }

 private:
  static ceres::Problem::Options borrowing() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  /// A firm edge's squared error may be as many times larger before its cost is no longer squared.
  ceres::LossFunction* loss_of(const SwitchableEdge& edge) {
    if (edge.firmness == 1.0) return &loss_;
    return &firm_losses_.emplace_back(options_.huber_scale * std::sqrt(edge.firmness));
  }

  template <typename AnyEdge>
  void add_edge(const AnyEdge& edge, ceres::LossFunction* loss) {
    const Eigen::Matrix3d W = whitening_or_throw(edge.constraint.covariance, options_.whitening, describe(edge));
    problem_.AddResidualBlock(new RelativePoseCost(edge.constraint.T_i_j, W), loss, nodes_[edge.i].data(),
                              nodes_[edge.j].data());
  }

  void add_observation(const LandmarkObservation& o, const Eigen::Matrix3d& W, Block& landmark) {
    if (o.before == o.after) {  // at a node: Ceres takes a block once only
      problem_.AddResidualBlock(new RelativePoseCost(o.T_sensor_landmark, W), &loss_, nodes_[o.before].data(),
                                landmark.data());
    } else {
      problem_.AddResidualBlock(new LandmarkCost(o.fraction, o.T_sensor_landmark, W), &loss_, nodes_[o.before].data(),
                                nodes_[o.after].data(), landmark.data());
    }
  }

  OptimizerOptions options_;
  ceres::HuberLoss loss_;
  std::deque<ceres::HuberLoss> firm_losses_;
  std::vector<Block> nodes_;
  std::map<std::uint64_t, Block> landmarks_;
  ceres::Problem problem_;
};

}  // namespace

OptimizerSummary optimize_with_landmarks(Graph& graph, const std::vector<LandmarkObservation>& observations,
                                         Landmarks& landmarks, const OptimizerOptions& options) {
  check_options(options);
  check_graph(graph);
  HuberProblem problem(graph, options);
  problem.add(observations, landmarks);
  const ceres::Solver::Summary solved = problem.solve();
  if (!solved.IsSolutionUsable()) throw InputError("the graph cannot be solved: " + solved.message);
  problem.write_back(graph, landmarks);
  OptimizerSummary summary;
  summary.converged = solved.termination_type == ceres::CONVERGENCE;
  summary.iterations = solved.num_successful_steps + solved.num_unsuccessful_steps;
  summary.initial_cost = solved.initial_cost;
  summary.final_cost = solved.final_cost;
  summary.message = summary.converged ? "converged" : "reached the limit of iterations";
  for (SwitchableEdge& edge : graph.switchable_edges) {
    const Eigen::Vector3d error =
        constraint_error(graph.nodes[edge.i].pose, graph.nodes[edge.j].pose, edge.constraint.T_i_j);
    const double chi2 = (whitening_matrix(edge.constraint.covariance, options.whitening) * error).squaredNorm();
    summary.chi_squared.push_back(chi2);
    const double weight = std::min(1.0, options.huber_scale / std::max(std::sqrt(chi2), 1e-300));
    edge.switch_value = std::sqrt(weight);  // a switch s weighs an edge by s^2
  }
  return summary;
}

}  // namespace oort
