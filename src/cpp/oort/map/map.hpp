// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "oort/graph/graph.hpp"
#include "oort/map/point_clouds.hpp"

namespace oort {

/// How a node was linked to the one before it on its trajectory (the map file's IncrGraphResult).
struct IncrementalResult {
  std::uint64_t id = 0;                                  ///< the node
  std::uint64_t target = 0;                              ///< the node before it; itself for the first of a segment
  Pose2 T_local_id;                                      ///< the node's pose in the scan matcher's own frame ("smTid")
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of T_local_id
  Pose2 T_target_id;
  double inlier_ratio = 0.0;  ///< share of the returns of the node's cloud, in [0, 1]
};

/// How a loop was closed (the map file's LoopGraphResult).
struct LoopResult {
  std::uint64_t id = 0;  ///< the node this result was produced at; for a dock closure the dock's node
  std::uint64_t target = 0;
  Pose2 T_id_target;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of T_id_target, along the axes of node id
  double inlier_ratio = 0.0;
};

/// A named place, kept relative to a node so that it moves with the map.
struct Location {
  std::string name_space;  ///< "dock" is reserved for docks
  std::string id;
  std::uint64_t node_id = 0;
  Pose2 T_node_location;
};

/// Everything that makes a map: what the map file holds.
struct Map {
  Graph graph;
  PointClouds clouds;  ///< one per node, in the order of the nodes, in the sensor's frame
  std::vector<IncrementalResult> incremental_results;
  std::vector<LoopResult> loop_results;
  std::vector<Location> locations;
};

}  // namespace oort
