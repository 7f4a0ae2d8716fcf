// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "oort/geometry/pose2.hpp"

namespace oort {

/// The pose of the sensor at one place of the drive.
struct Node {
  std::uint64_t id = 0;  ///< nodes are stored in the order of their ids; ids are consecutive from 0
  Pose2 pose;            ///< T_map_sensor
};

enum class ConstraintType { kLaser, kOdometry };

/// What was measured between two nodes.
struct Constraint {
  double time = 0.0;     ///< stamp of the cloud of node `id` [s]
  std::uint64_t id = 0;  ///< the node it was calculated at (no bearing on direction)
  Pose2 T_i_j;           ///< pose of node j in the frame of node i
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of T_i_j: x, y, theta along the axes of node i
  ConstraintType type = ConstraintType::kLaser;
};

/// An edge that is always believed: between consecutive nodes of a trajectory, or from a segment to the next.
struct Edge {
  std::uint64_t id = 0;  ///< one counter serves both kinds of edges
  std::uint64_t i = 0;
  std::uint64_t j = 0;
  Constraint constraint;
};

/// A switch that is on: at least as close to 1 as to 0.
constexpr double kSwitchOn = 0.5;

/// An edge that the optimiser may switch off (Suenderhauf and Protzel 2012).
struct SwitchableEdge {
  std::uint64_t id = 0;
  std::uint64_t i = 0;
  std::uint64_t j = 0;
  Constraint constraint;
  double switch_value = 1.0;  ///< in [0, 1]; 1 is on; kept between solves
  /// How many times as much as for other edges it costs to switch it off. Not in map files: who knows what the edge is
  /// sets it.
  double firmness = 1.0;

  /// Whether it is believed.
  bool is_on() const { return switch_value >= kSwitchOn; }
};

struct Graph {
  std::vector<Node> nodes;
  std::vector<Edge> edges;
  std::vector<SwitchableEdge> switchable_edges;
};

/// The id after those of all edges of either kind.
std::uint64_t next_edge_id(const Graph& graph);

}  // namespace oort
