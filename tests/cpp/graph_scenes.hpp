// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
// Pose graphs for the tests of the optimiser.
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "oort/graph/graph.hpp"

namespace oort {

inline const Eigen::Matrix3d kCovariance = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();

inline Edge chain_edge(std::uint64_t id, std::uint64_t i, std::uint64_t j, const Pose2& T_i_j) {
  return {id, i, j, {0.0, j, T_i_j, kCovariance, ConstraintType::kLaser}};
}

inline SwitchableEdge closure(std::uint64_t id, std::uint64_t i, std::uint64_t j, const Pose2& T_i_j) {
  return {id, i, j, {0.0, i, T_i_j, kCovariance, ConstraintType::kLaser}, 1.0};
}

/// A drive of `laps` rounds about a square of side 4 m in steps of 1 m, with a turn at each corner: the true poses.
inline std::vector<Pose2> square_truth(int laps) {
  std::vector<Pose2> poses = {{0.0, 0.0, 0.0}};
  for (int k = 1; k < 16 * laps; ++k) poses.push_back(poses.back() * Pose2{1.0, 0.0, k % 4 == 0 ? M_PI / 2.0 : 0.0});
  return poses;
}

/// The same drive as odometry sees it, each turn and step a little off: nodes and a chain of edges.
inline Graph square_graph(int laps, unsigned seed) {
  const std::vector<Pose2> truth = square_truth(laps);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  Graph graph;
  graph.nodes.push_back({0, truth[0]});
  for (std::uint64_t k = 1; k < truth.size(); ++k) {
    Pose2 step = between(truth[k - 1], truth[k]);
    step.x += 0.005 * noise(random);
    step.y += 0.005 * noise(random);
    step.theta += 0.002 * noise(random);
    graph.edges.push_back(chain_edge(k - 1, k - 1, k, step));
    graph.nodes.push_back({k, graph.nodes.back().pose * step});
  }
  return graph;
}

/// Closures, without error, from each node of the second lap to the node of the first lap at the same place.
inline void close_laps(Graph& graph, int laps) {
  const std::vector<Pose2> truth = square_truth(laps);
  for (std::uint64_t k = 16; k < truth.size(); ++k) {
    graph.switchable_edges.push_back(closure(100 + k, k - 16, k, between(truth[k - 16], truth[k])));
  }
}

inline double distance(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

}  // namespace oort
