// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/closure_confirmation.hpp"

#include <algorithm>
#include <cmath>

#include "oort/loop_closure/tuning.hpp"

namespace oort {
namespace {

/// Whether going from one query to the other by the two closures leads to where the drive did.
bool agree(const Map& map, const Closure& a, const Closure& b) {
  const auto& nodes = map.graph.nodes;
  const Pose2 by_closures = a.T_from_to * between(nodes[a.to].pose, nodes[b.to].pose) * inverse(b.T_from_to);
  const Pose2 difference = between(between(nodes[a.from].pose, nodes[b.from].pose), by_closures);
  return difference.translation().norm() <= LoopClosureTuning::kConfirmationDistance &&
         std::abs(difference.theta) <= LoopClosureTuning::kConfirmationAngle;
}

}  // namespace

std::vector<Closure> ClosureConfirmation::add(const Map& map, const Closure& closure) {
  const auto is_old = [&](const Closure& other) {  // maps that are merged are also gone through backwards
    return std::max(other.from, closure.from) - std::min(other.from, closure.from) >
           LoopClosureTuning::kConfirmationAge;
  };
  waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), is_old), waiting_.end());
  std::vector<Closure> confirmed;
  double travel = 0.0;
  const Eigen::Vector2d here = map.graph.nodes[closure.from].pose.translation();
  for (const Closure& other : waiting_) {
    if (!agree(map, other, closure)) continue;
    confirmed.push_back(other);
    travel = std::max(travel, (map.graph.nodes[other.from].pose.translation() - here).norm());
  }
  confirmed.push_back(closure);
  if (confirmed.size() < LoopClosureTuning::kConfirmations || travel < LoopClosureTuning::kConfirmationTravel) {
    waiting_.push_back(closure);
    return {};
  }
  const auto is_confirmed = [&](const Closure& other) {
    return std::any_of(confirmed.begin(), confirmed.end(),
                       [&](const Closure& c) { return c.from == other.from && c.to == other.to; });
  };
  waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), is_confirmed), waiting_.end());
  return confirmed;
}

}  // namespace oort
