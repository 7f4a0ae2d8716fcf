// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/place_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "oort/mapper/tuning.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

/// Of the returns of two nodes: those in a direction in which the other one saw something, and of them those that lie
/// well before it, on what must be free.
struct Comparison {
  int compared = 0;
  int in_free = 0;
};

/// The nearest return by bearing.
class Profile {
 public:
  explicit Profile(const frsm::Points& points) {
    nearest_.fill(std::numeric_limits<double>::infinity());
    for (const frsm::Point& p : points) {
      double& nearest = nearest_[sector_of(p.x, p.y)];
      nearest = std::min(nearest, std::hypot(p.x, p.y));
    }
  }

  /// Adds the returns of another node, which is seen at a pose.
  void compare(const frsm::Points& points, const Pose2& T_this_other, Comparison& sum) const {
    for (const frsm::Point& point : points) {
      const Eigen::Vector2d p = T_this_other * Eigen::Vector2d(point.x, point.y);
      const double range = p.norm();
      const std::size_t sector = sector_of(p.x(), p.y());
      if (std::isinf(nearest_[sector])) continue;
      const double seen =
          std::min({nearest_[sector], nearest_[(sector + 1) % kSectors], nearest_[(sector + kSectors - 1) % kSectors]});
      ++sum.compared;
      if (range < seen - MapperTuning::kFreeMargin - MapperTuning::kFreeMarginShare * range) ++sum.in_free;
    }
  }

 private:
  static constexpr std::size_t kSectors = 180;

  static std::size_t sector_of(double x, double y) {
    const double turns = std::atan2(y, x) / (2.0 * M_PI) + 0.5;
    return static_cast<std::size_t>(turns * static_cast<double>(kSectors)) % kSectors;
  }

  std::array<double, kSectors> nearest_{};
};

double apart(const Pose2& a, const Pose2& b) {
  const Pose2 d = between(a, b);
  return d.translation().norm() + MapperTuning::kWatchLever * std::abs(d.theta);
}

/// Older nodes, the nearest first, that see about what a node sees.
std::vector<std::uint64_t> neighbours_of(const Map& map, std::uint64_t node) {
  std::vector<std::pair<double, std::uint64_t>> near;
  const Pose2& pose = map.graph.nodes[node].pose;
  for (std::uint64_t other = 0; other + MapperTuning::kWatchAge < node; ++other) {
    const Pose2& its_pose = map.graph.nodes[other].pose;
    if ((its_pose.translation() - pose.translation()).norm() > MapperTuning::kWatchReach) continue;
    const double distance = apart(pose, its_pose);
    if (distance < MapperTuning::kWatchReach) near.emplace_back(distance, other);
  }
  const std::size_t count = std::min(near.size(), MapperTuning::kWatchNeighbours);
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
  std::vector<std::uint64_t> nodes;
  for (std::size_t k = 0; k < count; ++k) nodes.push_back(near[k].second);
  return nodes;
}

}  // namespace

void PlaceWatch::look(const Map& map, std::uint64_t node, WorkMeter* meter) {
  const std::vector<std::uint64_t> neighbours = neighbours_of(map, node);
  const frsm::Points points = returns_of(map.clouds[node]);
  charge(meter, MapperTuning::kWorkPerWatched * static_cast<double>(node) +
                    MapperTuning::kWorkPerCompared * static_cast<double>((neighbours.size() + 1) * points.size()));
  if (neighbours.empty() || points.empty()) return;
  const Profile profile(points);
  Comparison sum;
  for (const std::uint64_t other : neighbours) {
    const frsm::Points its_points = returns_of(map.clouds[other]);
    const Pose2 T_other_node = between(map.graph.nodes[other].pose, map.graph.nodes[node].pose);
    Profile(its_points).compare(points, T_other_node, sum);
    profile.compare(its_points, inverse(T_other_node), sum);
  }
  if (sum.compared < MapperTuning::kLeastCompared) return;
  seen_.push_back({node, static_cast<double>(sum.in_free) / sum.compared});
  if (seen_.size() > MapperTuning::kWatched) seen_.pop_front();
}

std::optional<std::uint64_t> PlaceWatch::first_suspect() const {
  const auto is_suspect = [](const Seen& seen) { return seen.contradicting > MapperTuning::kSuspectShare; };
  if (std::count_if(seen_.begin(), seen_.end(), is_suspect) < MapperTuning::kSuspects) return std::nullopt;
  return std::find_if(seen_.begin(), seen_.end(), is_suspect)->node;
}

}  // namespace oort
