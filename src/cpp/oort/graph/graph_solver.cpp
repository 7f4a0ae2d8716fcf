// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/graph_solver.hpp"

#include <algorithm>
#include <utility>

#include "oort/graph/internal/residuals.hpp"
#include "oort/graph/tuning.hpp"

namespace oort {

GraphSolver::GraphSolver(std::vector<Pose2> poses, std::vector<int> variables, std::vector<SolverEdge> edges,
                         double scale)
    : poses_(std::move(poses)), variables_(std::move(variables)), edges_(std::move(edges)), scale_(scale) {
  for (const int variable : variables_) variable_count_ = std::max(variable_count_, variable + 1);
  cholesky_.analyze(static_cast<std::size_t>(variable_count_), {});
}

bool GraphSolver::use(const std::vector<bool>& on) {
  if (on == on_) return false;
  on_ = on;
  damping_ = GraphTuning::kInitialDamping;
  active_.clear();
  pair_of_.clear();
  std::vector<BlockPair> pairs;
  for (std::size_t k = 0; k < edges_.size(); ++k) {
    edges_[k].on = on[k];
    const int i = variables_[edges_[k].i], j = variables_[edges_[k].j];
    if (!on[k] || (i < 0 && j < 0)) continue;
    active_.push_back(k);
    pair_of_.push_back(pairs.size());
    if (i >= 0 && j >= 0) pairs.push_back({i, j});
  }
  charge(meter_,
         GraphTuning::kWorkPerPattern * static_cast<double>(pairs.size() + static_cast<std::size_t>(variable_count_)));
  cholesky_.analyze(static_cast<std::size_t>(variable_count_), pairs);
  return true;
}

GraphSolver::Progress GraphSolver::step(double tolerance) {
  charge(meter_, GraphTuning::kWorkPerEdge * static_cast<double>(active_.size()));
  linearize();
  std::vector<double> switches;
  for (const std::size_t k : active_) switches.push_back(edges_[k].s);
  const double before = cost(poses_, switches);
  std::vector<Eigen::Vector3d> damping(descent_.size());
  for (; damping_ <= GraphTuning::kMaxDamping;
       damping_ = GraphTuning::kDampingGrowth * std::max(damping_, GraphTuning::kInitialDamping)) {
    for (int k = 0; k < variable_count_; ++k) {
      damping[k] = damping_ * cholesky_.diagonal(k).cwiseMax(GraphTuning::kMinDiagonal);
    }
    charge(meter_, GraphTuning::kWorkPerBlock * static_cast<double>(cholesky_.fill()) +
                       GraphTuning::kWorkPerProduct * static_cast<double>(cholesky_.products()));
    if (!cholesky_.factorize(damping)) continue;
    delta_ = descent_;
    cholesky_.solve(delta_);
    double promised = 0.0;  // by which the cost should fall: half of what the step and the gradient have in common
    for (std::size_t k = 0; k < delta_.size(); ++k) promised += 0.5 * delta_[k].dot(descent_[k]);
    for (const Eliminated& e : eliminated_) promised += 0.5 * e.gradient * e.gradient / e.curvature;
    const bool small = promised <= tolerance + GraphTuning::kRelativeTolerance * before;

    std::vector<Pose2> poses = moved_poses();
    switches = moved_switches();
    if (cost(poses, switches) <= before) {
      poses_ = std::move(poses);
      for (std::size_t a = 0; a < active_.size(); ++a) edges_[active_[a]].s = switches[a];
      damping_ = std::max(GraphTuning::kDampingDecay * damping_, GraphTuning::kMinDamping);
      return small ? Progress::kConverged : Progress::kMoved;
    }
    if (small) return Progress::kConverged;
  }
  return Progress::kStuck;
}

double GraphSolver::squared_error(const SolverEdge& edge, const std::vector<Pose2>& poses) const {
  return (edge.W * constraint_error(poses[edge.i], poses[edge.j], edge.T_i_j)).squaredNorm();
}

double GraphSolver::cost(const std::vector<Pose2>& poses, const std::vector<double>& switches) const {
  double sum = 0.0;
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const SolverEdge& edge = edges_[active_[a]];
    const double chi2 = squared_error(edge, poses);
    if (edge.switchable) {
      const double s = switches[a];
      sum += s * s * chi2 + scale_of(edge) * (1.0 - s) * (1.0 - s);
    } else {
      sum += chi2;
    }
  }
  return 0.5 * sum;
}

void GraphSolver::linearize() {
  cholesky_.set_zero();
  descent_.assign(static_cast<std::size_t>(variable_count_), Eigen::Vector3d::Zero());
  eliminated_.clear();
  for (std::size_t place = 0; place < active_.size(); ++place) add_edge(place);
}

void GraphSolver::add_edge(std::size_t place) {
  const SolverEdge& edge = edges_[active_[place]];
  const Pose2 &T_map_i = poses_[edge.i], &T_map_j = poses_[edge.j];
  const Eigen::Vector3d r = edge.W * constraint_error(T_map_i, T_map_j, edge.T_i_j);
  const ErrorJacobians jacobians = constraint_jacobians(T_map_i, T_map_j);
  const Eigen::Matrix3d A_i = edge.W * jacobians.of_i;
  const Eigen::Matrix3d A_j = edge.W * jacobians.of_j;
  Eigen::Matrix3d H_ii = A_i.transpose() * A_i;
  Eigen::Matrix3d H_ij = A_i.transpose() * A_j;
  Eigen::Matrix3d H_jj = A_j.transpose() * A_j;
  const Eigen::RowVector3d rA_i = r.transpose() * A_i;
  const Eigen::RowVector3d rA_j = r.transpose() * A_j;
  double pull = 1.0;
  if (edge.switchable) {
    const double s = edge.s, chi2 = r.squaredNorm(), h = chi2 + scale_of(edge);
    const double g = s * chi2 - scale_of(edge) * (1.0 - s);
    H_ii = s * s * (H_ii - rA_i.transpose() * (rA_i / h));
    H_ij = s * s * (H_ij - rA_i.transpose() * (rA_j / h));
    H_jj = s * s * (H_jj - rA_j.transpose() * (rA_j / h));
    pull = s * s - s * g / h;
    eliminated_.push_back({place, g, h, rA_i, rA_j});
  }
  const int i = variables_[edge.i], j = variables_[edge.j];
  if (i >= 0) {
    cholesky_.add_diagonal(i, H_ii);
    descent_[i] -= pull * rA_i.transpose();
  }
  if (j >= 0) {
    cholesky_.add_diagonal(j, H_jj);
    descent_[j] -= pull * rA_j.transpose();
  }
  if (i >= 0 && j >= 0) cholesky_.add_pair(pair_of_[place], H_ij);
}

std::vector<Pose2> GraphSolver::moved_poses() const {
  std::vector<Pose2> poses = poses_;
  for (std::size_t node = 0; node < poses.size(); ++node) {
    if (is_held(node)) continue;
    const Eigen::Vector3d& delta = delta_[variables_[node]];
    poses[node] = {poses[node].x + delta.x(), poses[node].y + delta.y(), poses[node].theta + delta.z()};
  }
  return poses;
}

std::vector<double> GraphSolver::moved_switches() const {
  std::vector<double> switches;
  for (const std::size_t k : active_) switches.push_back(edges_[k].s);
  for (const Eliminated& e : eliminated_) {
    const SolverEdge& edge = edges_[active_[e.edge]];
    double change = e.gradient;
    if (const int i = variables_[edge.i]; i >= 0) change += edge.s * e.rA_i.dot(delta_[i]);
    if (const int j = variables_[edge.j]; j >= 0) change += edge.s * e.rA_j.dot(delta_[j]);
    switches[e.edge] -= change / e.curvature;
  }
  return switches;
}

}  // namespace oort
