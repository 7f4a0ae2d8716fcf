// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapping/submaps.hpp"

#include <algorithm>
#include <cmath>

#include "oort/matching/frsm_adapter.hpp"

namespace oort {

namespace {

void draw_scan(const Map& map, const Chains& chains, std::uint64_t origin, std::uint64_t node,
               const frsm::ContourParams& contours, frsm::Table& table) {
  const frsm::Pose T_origin_node = to_frsm(between(chains.local_pose(origin), chains.local_pose(node)));
  const frsm::Points points = returns_of(map.clouds[node]);
  table.draw(frsm::transform(T_origin_node, points), frsm::extract_contours(points, contours), T_origin_node);
}

}  // namespace

std::shared_ptr<const frsm::Table> draw_submap(const Map& map, const Chains& chains, std::uint64_t origin,
                                               const std::vector<std::uint64_t>& nodes, const frsm::TableParams& table,
                                               const frsm::ContourParams& contours) {
  auto drawn = std::make_shared<frsm::Table>(table);
  for (const std::uint64_t node : nodes) draw_scan(map, chains, origin, node, contours, *drawn);
  return drawn;
}

frsm::Points gather_points(const Map& map, const Chains& chains, std::uint64_t origin,
                           const std::vector<std::uint64_t>& nodes, double reach) {
  frsm::Points points;
  for (const std::uint64_t node : nodes) {
    frsm::Points seen = returns_of(map.clouds[node]);
    seen.erase(std::remove_if(seen.begin(), seen.end(),
                              [reach](const frsm::Point& p) { return std::hypot(p.x, p.y) > reach; }),
               seen.end());
    append_transformed(seen, between(chains.local_pose(origin), chains.local_pose(node)), points);
  }
  return points;
}

SubmapCache::SubmapCache(std::uint64_t neighborhood_size, std::size_t max_bytes, const frsm::TableParams& table,
                         const frsm::ContourParams& contours)
    : neighborhood_size_(neighborhood_size), max_bytes_(max_bytes), table_(table), contours_(contours) {}

std::shared_ptr<const frsm::Table> SubmapCache::get(const Map& map, const Chains& chains, std::uint64_t node) {
  const std::vector<std::uint64_t> nodes = chains.neighborhood(node, neighborhood_size_);
  Entry& entry = latest(node);
  draw_more(map, chains, nodes, nodes.size(), entry);
  forget_oldest();
  return entries_.front().table;
}

bool SubmapCache::draw(const Map& map, const Chains& chains, std::uint64_t node, std::uint64_t scans) {
  const std::vector<std::uint64_t> nodes = chains.neighborhood(node, neighborhood_size_);
  Entry& entry = latest(node);
  if (entry.drawn == nodes.size()) return false;
  draw_more(map, chains, nodes, std::min<std::size_t>(nodes.size(), entry.drawn + scans), entry);
  return true;
}

SubmapCache::Entry& SubmapCache::latest(std::uint64_t node) {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [node](const Entry& entry) { return entry.node == node; });
  if (found != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, found);
  } else {
    entries_.push_front({node, std::make_shared<frsm::Table>(table_), 0});
  }
  return entries_.front();
}

void SubmapCache::draw_more(const Map& map, const Chains& chains, const std::vector<std::uint64_t>& nodes,
                            std::size_t end, Entry& entry) const {
  for (; entry.drawn < end; ++entry.drawn) {
    draw_scan(map, chains, entry.node, nodes[entry.drawn], contours_, *entry.table);
  }
}

// Tables grow after they were handed out, when their bounds for branch and bound are built: they are counted anew.
void SubmapCache::forget_oldest() {
  std::size_t bytes = 0;
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    bytes += entry->table->bytes();
    if (bytes > max_bytes_ && entry != entries_.begin()) {
      entries_.erase(entry, entries_.end());
      break;
    }
  }
}

}  // namespace oort
