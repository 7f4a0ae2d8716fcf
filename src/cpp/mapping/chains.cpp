// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapping/chains.hpp"

#include <algorithm>
#include <numeric>

namespace oort {
namespace {

// A link this uncertain (standard deviation of x or y) joins no submap: pauses and resumes inflate to metres, while
// a link that follows odometry stays below a decimetre or two.
constexpr double kMaxRigidDeviation = 0.5;  // [m]

bool is_rigid(const Eigen::Matrix3d& covariance) {
  return std::max(covariance(0, 0), covariance(1, 1)) < kMaxRigidDeviation * kMaxRigidDeviation;
}

}  // namespace

void Chains::add(bool begins_segment, const Pose2& T_local_sensor) {
  const std::uint64_t node = local_poses_.size();
  first_.push_back(begins_segment || node == 0 ? node : first_.back());
  local_poses_.push_back(T_local_sensor);
}

Chains Chains::of_map(const Map& map) {
  std::vector<const Edge*> link_before(map.graph.nodes.size(), nullptr);
  for (const Edge& edge : map.graph.edges) {
    if (edge.i + 1 == edge.j) link_before[edge.j] = &edge;
  }
  Chains chains;
  for (std::uint64_t node = 0; node < link_before.size(); ++node) {
    const Edge* link = link_before[node];
    if (link == nullptr || !is_rigid(link->constraint.covariance)) {
      chains.add(true, Pose2{});
    } else {
      chains.add(false, chains.local_pose(node - 1) * link->constraint.T_i_j);
    }
  }
  return chains;
}

std::uint64_t Chains::segment_end(std::uint64_t node) const {
  const auto end = std::upper_bound(first_.begin(), first_.end(), first_[node]);
  return static_cast<std::uint64_t>(end - first_.begin());
}

std::vector<std::uint64_t> Chains::neighborhood(std::uint64_t node, std::uint64_t size) const {
  const std::uint64_t before = std::min(size / 2, node - segment_begin(node));
  const std::uint64_t end = std::min(segment_end(node), node - before + std::max<std::uint64_t>(size, 1));
  std::vector<std::uint64_t> nodes(end - (node - before));
  std::iota(nodes.begin(), nodes.end(), node - before);
  return nodes;
}

}  // namespace oort
