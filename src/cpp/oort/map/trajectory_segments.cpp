// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/map/trajectory_segments.hpp"

#include <algorithm>
#include <cmath>

#include "oort/map/tuning.hpp"

namespace oort {
namespace {

bool is_rigid(const Eigen::Matrix3d& covariance) {
  return std::max(covariance(0, 0), covariance(1, 1)) < MapTuning::kMaxRigidDeviation * MapTuning::kMaxRigidDeviation;
}

}  // namespace

void TrajectorySegments::add(bool begins_segment, bool matched, const Pose2& T_local_sensor) {
  const std::uint64_t node = local_poses_.size();
  const bool is_first = begins_segment || node == 0;
  const double step = is_first ? 0.0 : between(local_poses_.back(), T_local_sensor).translation().norm();
  const auto steps = static_cast<std::uint64_t>(std::max(1.0, std::round(step / MapTuning::kNodeSpacing)));
  travel_.push_back(node == 0 ? 0 : travel_.back() + steps);
  first_.push_back(is_first ? node : first_.back());
  matched_.push_back(matched);
  local_poses_.push_back(T_local_sensor);
}

void TrajectorySegments::split(std::uint64_t node) {
  const std::uint64_t end = segment_end(node);
  std::fill(first_.begin() + static_cast<std::ptrdiff_t>(node), first_.begin() + static_cast<std::ptrdiff_t>(end),
            node);
  matched_[node] = true;
}

TrajectorySegments TrajectorySegments::of_map(const Map& map) {
  const std::size_t size = map.graph.nodes.size();
  std::vector<const Edge*> step(size, nullptr);   // from the node before
  std::vector<const Edge*> match(size, nullptr);  // from the last node that was matched
  std::vector<bool> is_anchor(size, false);
  for (const Edge& edge : map.graph.edges) {
    if (edge.i + 1 == edge.j) step[edge.j] = &edge;
    if (edge.i < edge.j && edge.constraint.type == ConstraintType::kLaser) {
      match[edge.j] = &edge;
      is_anchor[edge.i] = true;
    }
  }
  TrajectorySegments segments;
  for (std::uint64_t node = 0; node < size; ++node) {
    // Without a match, but others were matched with it: the first of a new local map.
    if (match[node] == nullptr && (step[node] == nullptr || is_anchor[node])) {
      segments.add(true, true, Pose2{});
      continue;
    }
    const Edge& link = match[node] != nullptr ? *match[node] : *step[node];
    const bool rigid = is_rigid(link.constraint.covariance) && segments.same_segment(link.i, node - 1);
    segments.add(!rigid, !rigid || match[node] != nullptr,
                 rigid ? segments.local_pose(link.i) * link.constraint.T_i_j : Pose2{});
  }
  return segments;
}

std::uint64_t TrajectorySegments::segment_end(std::uint64_t node) const {
  const auto end = std::upper_bound(first_.begin(), first_.end(), first_[node]);
  return static_cast<std::uint64_t>(end - first_.begin());
}

std::uint64_t TrajectorySegments::travel_between(std::uint64_t a, std::uint64_t b) const {
  return travel_[std::max(a, b)] - travel_[std::min(a, b)];
}

bool TrajectorySegments::begins_stride(std::uint64_t node, std::uint64_t stride) const {
  const std::uint64_t begin = segment_begin(node);
  return node == begin || travel_between(begin, node) / stride != travel_between(begin, node - 1) / stride;
}

std::vector<std::uint64_t> TrajectorySegments::neighborhood(std::uint64_t node, std::uint64_t size) const {
  const std::uint64_t before = std::min(size / 2, travel_between(segment_begin(node), node));
  const std::uint64_t end_of_travel = travel_[node] - before + std::max<std::uint64_t>(size, 1);
  std::uint64_t first = node;
  while (first > segment_begin(node) && travel_between(first - 1, node) <= before) --first;
  std::vector<std::uint64_t> nodes;
  for (std::uint64_t other = first; other < segment_end(node) && travel_[other] < end_of_travel; ++other) {
    if (matched_[other] || other == node) nodes.push_back(other);
  }
  return nodes;
}

}  // namespace oort
