// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/view_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "oort/maintenance/tuning.hpp"

namespace oort {
namespace {

using Cell = std::pair<long, long>;

Cell cell_of(const Eigen::Vector2d& p) {
  return {std::lround(std::floor(p.x() / RefinementTuning::kPairReach)),
          std::lround(std::floor(p.y() / RefinementTuning::kPairReach))};
}

/// The middle of what a node saw, in the map; none if it saw no surface.
std::optional<Eigen::Vector2d> view_of(const Pose2& pose, const std::vector<SurfacePiece>& pieces) {
  if (pieces.empty()) return std::nullopt;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const SurfacePiece& piece : pieces) sum += piece.center;
  return pose * Eigen::Vector2d(sum / static_cast<double>(pieces.size()));
}

/// Of the candidates, those to be paired, nearest first.
std::vector<std::size_t> spread_out(std::vector<std::pair<double, std::size_t>> by_distance) {
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<std::size_t> chosen;
  for (const auto& [distance, node] : by_distance) {
    if (chosen.size() == RefinementTuning::kMaxPartners) break;
    const auto is_close = [node = node](std::size_t other) {
      return (other > node ? other - node : node - other) < RefinementTuning::kPartnerSpacing;
    };
    if (std::none_of(chosen.begin(), chosen.end(), is_close)) chosen.push_back(node);
  }
  return chosen;
}

}  // namespace

std::vector<ViewPair> view_pairs(const std::vector<Pose2>& poses,
                                 const std::vector<std::vector<SurfacePiece>>& pieces) {
  std::vector<ViewPair> pairs;
  std::map<Cell, std::vector<std::pair<std::size_t, Eigen::Vector2d>>> earlier;
  for (std::size_t node = 0; node < poses.size(); ++node) {
    const std::optional<Eigen::Vector2d> view = view_of(poses[node], pieces[node]);
    if (!view) continue;
    const Cell cell = cell_of(*view);
    std::vector<std::pair<double, std::size_t>> near;
    for (long x = cell.first - 1; x <= cell.first + 1; ++x) {
      for (long y = cell.second - 1; y <= cell.second + 1; ++y) {
        const auto others = earlier.find({x, y});
        if (others == earlier.end()) continue;
        for (const auto& [other, its_view] : others->second) {
          const double distance = (its_view - *view).norm();
          if (distance < RefinementTuning::kPairReach) near.emplace_back(distance, other);
        }
      }
    }
    for (const std::size_t partner : spread_out(std::move(near))) pairs.emplace_back(partner, node);
    earlier[cell].emplace_back(node, *view);
  }
  return pairs;
}

}  // namespace oort
