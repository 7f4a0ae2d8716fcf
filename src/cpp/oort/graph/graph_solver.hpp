// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
// Internal to the optimiser.
#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "oort/geometry/pose2.hpp"
#include "oort/geometry/work_meter.hpp"
#include "oort/graph/block_cholesky.hpp"

namespace oort {

/// An edge, ready to be solved with.
struct SolverEdge {
  std::size_t i = 0;  ///< nodes
  std::size_t j = 0;
  Pose2 T_i_j;
  Eigen::Matrix3d W;  ///< whitening matrix (residuals.hpp)
  bool switchable = false;
  double firmness = 1.0;  ///< times `scale` is what it costs to switch it off
  double s = 1.0;         ///< switch
  bool on = true;         ///< whether it takes part in solving
};

/// Finds the poses, and the switches, at which the edges that take part cost least:
///
///   1/2 sum over edges that are always believed of |W e|^2
///   + 1/2 sum over switchable edges of s^2 |W e|^2 + scale (1 - s)^2,
///
/// where scale is as many times larger as an edge is firm (Suenderhauf and Protzel 2012, "Switchable Constraints for
/// Robust Pose Graph SLAM", with Psi(s) = s, gamma = 1 and the variance 1 / scale.) By Gauss-Newton steps with the
/// damping of Levenberg and Marquardt. Each switch appears in one edge only, so it is eliminated before the poses are
/// solved for (the Schur complement): with r = W e, A = W de/dposes, chi2 = |r|^2, h = chi2 + scale and g = s chi2 -
/// scale (1 - s),
///
///   the edge adds  s^2 A^T (I - r r^T / h) A  to the matrix and  -(s^2 - s g / h) A^T r  to the right-hand side;
///   its switch then moves by  ds = -(g + s r^T A dposes) / h.
///
/// A false edge's pull along its error r thus fades at once, while it still holds its ends against the other
/// directions: which is much of what leads switches out of a bad start.
class GraphSolver {
 public:
  enum class Progress { kMoved, kConverged, kStuck };

  /// `variables` has one number per node: which variable its pose is, counting up from 0, or -1 if it is held.
  GraphSolver(std::vector<Pose2> poses, std::vector<int> variables, std::vector<SolverEdge> edges, double scale);

  /// Who counts the work of use() and step(); may be null.
  void set_meter(WorkMeter* meter) { meter_ = meter; }

  const std::vector<Pose2>& poses() const { return poses_; }
  const std::vector<SolverEdge>& edges() const { return edges_; }
  bool is_held(std::size_t node) const { return variables_[node] < 0; }
  /// |W e|^2 at the present poses.
  double squared_error(const SolverEdge& edge) const { return squared_error(edge, poses_); }
  /// The switch at which an edge costs least with the poses held: scale / (scale + chi2).
  double best_switch(const SolverEdge& edge, double chi2) const { return scale_of(edge) / (scale_of(edge) + chi2); }

  /// The chi2 at which a switch (above 0) is the best.
  double squared_error_at(const SolverEdge& edge, double s) const { return scale_of(edge) * (1.0 - s) / s; }

  void set_poses(std::vector<Pose2> poses) { poses_ = std::move(poses); }
  /// Whether the edge is one that may be switched off, for the steps to come.
  void set_switchable(std::size_t edge, bool switchable) { edges_[edge].switchable = switchable; }
  /// Where a switch starts.
  void set_switch(std::size_t edge, double s) { edges_[edge].s = s; }

  /// Says which edges take part (one flag for each). Returns whether that is anything new.
  bool use(const std::vector<bool>& on);

  /// What a step costs, in blocks of the factor.
  std::size_t fill() const { return cholesky_.fill(); }

  /// Tries one step. It has converged when the step promises to lower the cost by less than `tolerance`, or
  /// by next to nothing in proportion.
  Progress step(double tolerance);

 private:
  /// What the back substitution of a switch from the poses' step needs.
  struct Eliminated {
    std::size_t edge = 0;
    double gradient = 0.0;
    double curvature = 0.0;
    Eigen::RowVector3d rA_i, rA_j;
  };

  double scale_of(const SolverEdge& edge) const { return scale_ * edge.firmness; }
  double squared_error(const SolverEdge& edge, const std::vector<Pose2>& poses) const;
  double cost(const std::vector<Pose2>& poses, const std::vector<double>& switches) const;
  void linearize();
  void add_edge(std::size_t place);
  std::vector<Pose2> moved_poses() const;
  std::vector<double> moved_switches() const;

  std::vector<Pose2> poses_;
  std::vector<int> variables_;
  std::vector<SolverEdge> edges_;
  double scale_;
  int variable_count_ = 0;

  WorkMeter* meter_ = nullptr;
  std::vector<bool> on_;
  std::vector<std::size_t> active_;   // edges that take part and have an end that is not held
  std::vector<std::size_t> pair_of_;  // for each of them its place among the pairs of cholesky_
  BlockCholesky cholesky_;
  double damping_ = 0.0;
  std::vector<Eigen::Vector3d> descent_;  // the negative gradient
  std::vector<Eigen::Vector3d> delta_;    // the step
  std::vector<Eliminated> eliminated_;
};

}  // namespace oort
