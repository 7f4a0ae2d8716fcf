// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/closure.hpp"

#include <Eigen/Cholesky>

namespace oort {

double add_closure(const Closure& closure, std::uint64_t edge_id, Map& map) {
  const Pose2 expected = between(map.graph.nodes[closure.from].pose, map.graph.nodes[closure.to].pose);
  const Eigen::Vector3d error(expected.x - closure.T_from_to.x, expected.y - closure.T_from_to.y,
                              wrap_angle(expected.theta - closure.T_from_to.theta));
  map.graph.switchable_edges.push_back(
      {edge_id,
       closure.from,
       closure.to,
       {map.clouds[closure.from].time, closure.from, closure.T_from_to, closure.covariance, ConstraintType::kLaser},
       1.0,
       closure.firmness});
  map.loop_results.push_back({closure.from, closure.to, closure.T_from_to, closure.covariance, closure.inlier_ratio});
  return error.dot(closure.covariance.ldlt().solve(error));
}

OptimizerOptions optimizer_options(const Parameters& parameters, int max_iterations) {
  OptimizerOptions options;
  options.switchable_constraint_scale = parameters.switchable_constraint_scale;
  options.robust_kernel = parameters.robust_kernel == "huber" ? RobustKernel::kHuber : RobustKernel::kSwitchable;
  options.huber_scale = parameters.huber_scale;
  options.max_iterations = max_iterations;
  return options;
}

}  // namespace oort
