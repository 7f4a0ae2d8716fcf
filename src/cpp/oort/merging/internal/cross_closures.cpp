// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/merging/internal/cross_closures.hpp"

#include <algorithm>
#include <vector>

#include "oort/graph/optimizer.hpp"
#include "oort/local_slam/incremental_graph_builder.hpp"
#include "oort/local_slam/tuning.hpp"
#include "oort/loop_closure/dock_graph_builder.hpp"
#include "oort/loop_closure/loop_closure_builder.hpp"
#include "oort/mapper/solve_schedule.hpp"
#include "oort/mapper/tuning.hpp"
#include "oort/merging/internal/append_map.hpp"
#include "oort/merging/tuning.hpp"

namespace oort {
namespace {

Edge joint_edge(const Map& map, const Joint& joint) {
  const Pose2 T_before_after = between(map.graph.nodes[joint.before].pose, map.graph.nodes[joint.after].pose);
  const Eigen::Vector3d sigma(MergingTuning::kJointSigma, MergingTuning::kJointSigma, MergingTuning::kJointSigmaTheta);
  return {next_edge_id(map.graph),
          joint.before,
          joint.after,
          {map.clouds[joint.after].time, joint.after, T_before_after, sigma.cwiseAbs2().asDiagonal(),
           ConstraintType::kOdometry}};
}

/// From the joint to the last node, then from before the joint to the first.
std::vector<std::uint64_t> outwards(std::uint64_t begin, std::uint64_t joint, std::uint64_t end) {
  std::vector<std::uint64_t> nodes;
  for (std::uint64_t node = joint; node < end; ++node) nodes.push_back(node);
  for (std::uint64_t node = joint; node > begin; --node) nodes.push_back(node - 1);
  return nodes;
}

}  // namespace

ClosureCounts close_across(Map& map, std::uint64_t begin, const Joint& joint, const Parameters& parameters) {
  make_dock_closures_firm(map, parameters.dock_graph_builder.closure_firmness);
  const TrajectorySegments segments = TrajectorySegments::of_map(map);
  LoopClosureBuilder loops(parameters);
  ClosureCounts counts;
  ClosureLog log;
  const std::size_t link = map.graph.edges.size();
  map.graph.edges.push_back(joint_edge(map, joint));
  std::uint64_t next_id = next_edge_id(map.graph);
  SolveSchedule schedule(begin);  // a large innovation is where the nodes after those lie
  for (const std::uint64_t node : outwards(begin, joint.after, map.graph.nodes.size())) {
    loops.look_before(map, segments, node, begin);
    for (const Closure& closure : loops.work_off(map, segments, counts, log)) {
      schedule.add_closure(add_closure(closure, next_id++, map));
    }
    const SolveSchedule::Extent extent = schedule.due(map.graph.nodes.size(), counts.accepted);
    if (extent == SolveSchedule::Extent::kNothing) continue;
    OptimizerOptions options = optimizer_options(parameters, MapperTuning::kIterations);
    if (extent == SolveSchedule::Extent::kNewest) options.first_free_node = begin;
    optimize(map.graph, options);
    if (extent == SolveSchedule::Extent::kNewest) {
      schedule.solved_newest();
    } else {
      schedule.solved_all(counts.accepted);
    }
  }
  // Afterwards the joint is as wide as the first edge of a session: closures alone say where the segments lie.
  const double scale = edge_parameters(parameters.incremental_graph_builder).resume_scanmatch_cov_scale;
  map.graph.edges[link].constraint.covariance =
      LocalSlamTuning::kUnmatchedVariance * scale * scale * Eigen::Matrix3d::Identity();
  return counts;
}

}  // namespace oort
