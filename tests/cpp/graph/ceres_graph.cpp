// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "ceres_graph.hpp"

#include <ceres/autodiff_cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace oort {
namespace {

/// s L^T e with L L^T the information and e along the axes of node i.
struct LinkCost {
  explicit LinkCost(const Constraint& constraint) : z(constraint.T_i_j) {
    const Eigen::Matrix3d information = constraint.covariance.inverse();
    W = Eigen::LLT<Eigen::Matrix3d>(information).matrixU();
  }

  template <typename T>
  bool operator()(const T* i, const T* j, const T* s, T* residual) const {
    const T dx = j[0] - i[0], dy = j[1] - i[1], turn = j[2] - i[2] - z.theta;
    const Eigen::Matrix<T, 3, 1> e(cos(i[2]) * dx + sin(i[2]) * dy - z.x, cos(i[2]) * dy - sin(i[2]) * dx - z.y,
                                   atan2(sin(turn), cos(turn)));
    Eigen::Map<Eigen::Matrix<T, 3, 1>>(residual, 3) = s[0] * (W.cast<T>() * e);
    return true;
  }

  Pose2 z;
  Eigen::Matrix3d W;
};

struct SwitchCost {
  template <typename T>
  bool operator()(const T* s, T* residual) const {
    residual[0] = std::sqrt(scale) * (1.0 - s[0]);
    return true;
  }

  double scale;
};

}  // namespace

void solve_with_ceres(Graph& graph, double scale) {
  std::vector<std::array<double, 3>> poses;
  for (const Node& node : graph.nodes) poses.push_back({node.pose.x, node.pose.y, node.pose.theta});
  std::vector<double> s(graph.switchable_edges.size(), 1.0);
  double one = 1.0;
  ceres::Problem problem;
  const auto add = [&](const auto& edge, double* switch_value) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<LinkCost, 3, 3, 3, 1>(new LinkCost(edge.constraint)),
                             nullptr, poses[edge.i].data(), poses[edge.j].data(), switch_value);
  };
  for (const Edge& edge : graph.edges) add(edge, &one);
  for (std::size_t k = 0; k < s.size(); ++k) {
    add(graph.switchable_edges[k], &s[k]);
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<SwitchCost, 1, 1>(new SwitchCost{scale}), nullptr, &s[k]);
  }
  problem.SetParameterBlockConstant(poses[0].data());
  problem.SetParameterBlockConstant(&one);
  ceres::Solver::Options options;
  options.max_num_iterations = 500;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  ASSERT_TRUE(summary.IsSolutionUsable()) << summary.message;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    graph.nodes[k].pose = {poses[k][0], poses[k][1], wrap_angle(poses[k][2])};
  }
  for (std::size_t k = 0; k < s.size(); ++k) graph.switchable_edges[k].switch_value = s[k];
}

}  // namespace oort
