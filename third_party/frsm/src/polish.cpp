// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "refine.hpp"

namespace frsm {
namespace {

constexpr int kMaxIterations = 12;
constexpr double kMinResidual2 = 0.05;  // of 1 - M: keeps points on the line from outweighing all others

struct Linearisation {
  double value = 0.0;                                  // of the objective
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();   // of its negative, Gauss-Newton
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // of the objective
};

Linearisation linearise(const Table& table, const Points& body, const Objective& objective, const Pose& pose) {
  Linearisation lin;
  const double c = std::cos(pose.theta);
  const double s = std::sin(pose.theta);
  const double per_point = objective.weight() / static_cast<double>(body.size());
  for (const Point& p : body) {
    const double rx = c * p.x - s * p.y;
    const double ry = s * p.x + c * p.y;
    Eigen::Vector3d g;
    const double m = table.interpolate(pose.x + rx, pose.y + ry, &g[0], &g[1]);
    lin.value += per_point * m;
    if (g[0] == 0.0 && g[1] == 0.0) continue;
    g[2] = ry * -g[0] + rx * g[1];
    lin.gradient += per_point * g;
    // r = sqrt(1 - M), J = -g / (2 r):  weight * sum M = const - weight * sum r^2, whose Hessian is 2 J^T J per point.
    lin.hessian += per_point / (2.0 * std::max(kMinResidual2, 1.0 - m)) * g * g.transpose();
  }
  if (const auto& prior = objective.gaussian()) {
    const Eigen::Vector3d d(pose.x - prior->mean.x, pose.y - prior->mean.y, wrap(pose.theta - prior->mean.theta));
    lin.value += objective.prior(pose);
    lin.gradient -= objective.information() * d;
    lin.hessian += objective.information();
  }
  return lin;
}

// The damped step, cut at the bounds about the start.
Pose step(const Linearisation& lin, double damping, const Pose& from, const Pose& start, const Bounds& bounds) {
  Eigen::Matrix3d damped = lin.hessian;
  damped.diagonal() *= 1.0 + damping;
  damped.diagonal().array() += 1e-9 * (1.0 + lin.hessian.diagonal().maxCoeff());  // a flat direction stays where it is
  const Eigen::Vector3d d = damped.ldlt().solve(lin.gradient);
  const auto cut = [](double value, double limit) { return std::clamp(value, -limit, limit); };
  return {start.x + cut(from.x + d[0] - start.x, bounds.x), start.y + cut(from.y + d[1] - start.y, bounds.y),
          wrap(start.theta + cut(wrap(from.theta + d[2] - start.theta), bounds.theta))};
}

}  // namespace

Pose polish(const Table& table, const Points& body, const Objective& objective, const Pose& start,
            const Bounds& bounds) {
  Pose pose = start;
  Linearisation here = linearise(table, body, objective, pose);
  double damping = 1e-3;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Pose next = step(here, damping, pose, start, bounds);
    const Linearisation there = linearise(table, body, objective, next);
    const double gain = there.value - here.value;
    if (gain > 0.0) {
      pose = next;
      here = there;
      damping *= 0.2;
      if (gain < 1e-5 * objective.weight()) break;
    } else {
      damping = std::max(damping * 8.0, 1e-2);
      if (damping > 1e3) break;
    }
  }
  return pose;
}

}  // namespace frsm
