// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/outdated.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "oort/maintenance/evidence_grid.hpp"
#include "oort/maintenance/lifelong_tuning.hpp"
#include "oort/maintenance/tied_segments.hpp"

namespace oort {
namespace {

/// The nodes from `first_new` on whose place is known as seen from the older ones: that scans were matched at, in parts
/// of the map that older nodes belong to.
std::vector<std::uint64_t> witnesses(const Map& map, const TrajectorySegments& segments, std::uint64_t first_new) {
  const std::vector<std::uint64_t> parts = tied_parts(map.graph, segments);
  std::vector<std::uint64_t> nodes;
  for (std::uint64_t node = first_new; node < parts.size(); ++node) {
    if (segments.is_matched(node) && parts[node] < first_new) nodes.push_back(node);
  }
  return nodes;
}

double farthest_return(const Map& map, const std::vector<std::uint64_t>& nodes) {
  double farthest = 0.0;
  for (const std::uint64_t node : nodes) {
    for (const Point2& point : map.clouds[node].points) {
      if (point.is_return()) farthest = std::max(farthest, std::hypot(point.x, point.y));
    }
  }
  return farthest;
}

class Outdated {
 public:
  Outdated(const Map& map, const std::vector<std::uint64_t>& nodes, const GridLimits& limits, double reach,
           std::uint64_t first_new)
      : map_(map), reach_(reach), now_(limits), before_(limits) {
    for (const std::uint64_t node : nodes) now_.add(beams(node));
    for (std::uint64_t node = 0; node < first_new; ++node) before_.add(beams(node));
  }

  /// Which of a node's points are out of date.
  std::vector<bool> points(std::uint64_t node) const {
    std::vector<bool> outdated;
    for (const std::optional<Beam>& beam : beams(node))
      outdated.push_back(beam && (is_gone(*beam) || is_in_the_way(*beam)));
    return outdated;
  }

 private:
  std::vector<std::optional<Beam>> beams(std::uint64_t node) const {
    return beams_of(map_.clouds[node], map_.graph.nodes[node].pose, reach_);
  }

  /// Whether what a beam ended at is seen through.
  bool is_gone(const Beam& beam) const {
    if (!beam.is_return) return false;
    const std::optional<std::size_t> end = now_.cell(beam.end);
    return end && now_.misses_along(*end, beam) >= LifelongTuning::kMinSeeThrough && now_.hits_around(*end) == 0;
  }

  /// Whether something stands now where a beam went through and nothing was seen before.
  bool is_in_the_way(const Beam& beam) const {
    const std::vector<std::size_t> way = now_.way_of(beam);
    return std::any_of(way.begin(), way.end(), [this](std::size_t cell) {
      return now_.hits(cell) >= LifelongTuning::kMinSolid && 2 * now_.misses(cell) <= now_.hits(cell) &&
             before_.hits_around(cell) == 0;
    });
  }

  const Map& map_;
  double reach_;
  EvidenceGrid now_, before_;
};

}  // namespace

std::size_t remove_outdated(Map& map, const TrajectorySegments& segments, std::uint64_t first_new) {
  const std::vector<std::uint64_t> nodes = witnesses(map, segments, first_new);
  if (nodes.empty()) return 0;
  const double reach = LifelongTuning::kReachShare * farthest_return(map, nodes);
  Eigen::AlignedBox2d box;
  for (const std::uint64_t node : nodes) {
    for (const std::optional<Beam>& beam : beams_of(map.clouds[node], map.graph.nodes[node].pose, reach)) {
      if (beam) box.extend(beam->from).extend(beam->end);
    }
  }
  const double cells = box.isEmpty() ? 0.0 : box.sizes().prod() / std::pow(LifelongTuning::kEvidenceCell, 2);
  if (cells == 0.0 || cells > LifelongTuning::kMaxEvidenceCells) return 0;
  const Outdated outdated(map, nodes, GridLimits::enclosing(box, LifelongTuning::kEvidenceCell), reach, first_new);
  std::size_t removed = 0;
  for (std::uint64_t node = 0; node < first_new; ++node) {
    const std::vector<bool> points = outdated.points(node);
    const auto count = static_cast<std::size_t>(std::count(points.begin(), points.end(), true));
    if (count == 0) continue;
    PointCloud cloud = map.clouds[node];
    cloud.points.clear();
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (!points[k]) cloud.points.push_back(map.clouds[node].points[k]);
    }
    map.clouds.set(node, std::move(cloud));
    removed += count;
  }
  return removed;
}

}  // namespace oort
