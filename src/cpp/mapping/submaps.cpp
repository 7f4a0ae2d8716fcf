// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapping/submaps.hpp"

#include <algorithm>

#include "oort/matching/frsm_adapter.hpp"

namespace oort {

std::shared_ptr<const frsm::Table> draw_submap(const Map& map, const Chains& chains, std::uint64_t origin,
                                               const std::vector<std::uint64_t>& nodes, const frsm::TableParams& table,
                                               const frsm::ContourParams& contours) {
  auto drawn = std::make_shared<frsm::Table>(table);
  for (const std::uint64_t node : nodes) {
    const frsm::Pose T_origin_node = to_frsm(between(chains.local_pose(origin), chains.local_pose(node)));
    const frsm::Points points = returns_of(map.clouds[node]);
    drawn->draw(frsm::transform(T_origin_node, points), frsm::extract_contours(points, contours), T_origin_node);
  }
  return drawn;
}

frsm::Points gather_points(const Map& map, const Chains& chains, std::uint64_t origin,
                           const std::vector<std::uint64_t>& nodes) {
  frsm::Points points;
  for (const std::uint64_t node : nodes) {
    append_transformed(returns_of(map.clouds[node]), between(chains.local_pose(origin), chains.local_pose(node)),
                       points);
  }
  return points;
}

SubmapCache::SubmapCache(std::uint64_t neighborhood_size, std::size_t max_bytes, const frsm::TableParams& table,
                         const frsm::ContourParams& contours)
    : neighborhood_size_(neighborhood_size), max_bytes_(max_bytes), table_(table), contours_(contours) {}

std::shared_ptr<const frsm::Table> SubmapCache::get(const Map& map, const Chains& chains, std::uint64_t node) {
  const std::vector<std::uint64_t> nodes = chains.neighborhood(node, neighborhood_size_);
  const std::uint64_t end = nodes.back() + 1;
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [node](const Entry& entry) { return entry.node == node; });
  if (found != entries_.end() && found->end == end) {
    entries_.splice(entries_.begin(), entries_, found);
  } else {
    if (found != entries_.end()) entries_.erase(found);
    entries_.push_front({node, end, draw_submap(map, chains, node, nodes, table_, contours_)});
  }
  // Tables grow after they were handed out, when their bounds for branch and bound are built: count them anew.
  std::size_t bytes = 0;
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    bytes += entry->table->bytes();
    if (bytes > max_bytes_ && entry != entries_.begin()) {
      entries_.erase(entry, entries_.end());
      break;
    }
  }
  return entries_.front().table;
}

}  // namespace oort
