// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/matching/correlative_matcher.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "oort/matching/grid_score.hpp"
#include "oort/matching/tuning.hpp"

namespace oort {
namespace {

struct Candidate {
  Eigen::Vector3d offset;  // x, y [m], theta [rad] from the guess
  double score;
};

/// For each shift by up to `reach` cells, row by row, the sum of the values under some cells; unknown ones count 1, the
/// value of the least probability. A cell's row of neighbours is added at once, which compilers turn into vector code.
std::vector<std::uint32_t> sums_of_shifts(const ProbabilityGrid& grid, const std::vector<CellIndex>& cells, int reach) {
  constexpr std::uint16_t kLeast = 1;
  const GridLimits& limits = grid.limits();
  const int side = 2 * reach + 1;
  std::vector<std::uint32_t> sums(static_cast<std::size_t>(side * side), 0);
  for (const CellIndex& cell : cells) {
    for (int dy = 0; dy < side; ++dy) {
      std::uint32_t* const row = sums.data() + dy * side;
      const int x = cell.x() - reach;
      const int y = cell.y() - reach + dy;
      if (limits.contains(x, y) && limits.contains(x + side - 1, y)) {
        const std::uint16_t* const values = grid.values().data() + limits.index(x, y);
        for (int dx = 0; dx < side; ++dx) row[dx] += std::max(values[dx], kLeast);
      } else {
        for (int dx = 0; dx < side; ++dx) {
          row[dx] += limits.contains(x + dx, y) ? std::max(grid.values()[limits.index(x + dx, y)], kLeast) : kLeast;
        }
      }
    }
  }
  return sums;
}

}  // namespace

ScanMatch CorrelativeMatcher::match(const Points& points, const Pose2& guess) const {
  check_guess(guess);
  ScanMatch match;
  match.pose = guess;
  if (points.empty()) return match;
  const double step = grid_.limits().resolution;
  const double turn = std::max(angular_step(points, step), options_.angular_search_window / MatchingTuning::kMaxTurns);
  const int shifts = static_cast<int>(std::ceil(options_.linear_search_window / step));
  const int turns = static_cast<int>(std::ceil(options_.angular_search_window / turn));

  std::vector<Candidate> candidates;
  const Candidate* best = nullptr;
  candidates.reserve(static_cast<std::size_t>(2 * turns + 1) *
                     static_cast<std::size_t>((2 * shifts + 1) * (2 * shifts + 1)));
  for (int k = -turns; k <= turns; ++k) {
    // Points are turned once per heading; the shifts are then whole cells.
    const std::vector<CellIndex> cells = cells_of(points, {guess.x, guess.y, guess.theta + k * turn}, grid_.limits());
    const std::vector<std::uint32_t> sums = sums_of_shifts(grid_, cells, shifts);
    auto sum = sums.begin();
    for (int dy = -shifts; dy <= shifts; ++dy) {
      for (int dx = -shifts; dx <= shifts; ++dx, ++sum) {
        const Eigen::Vector3d offset(dx * step, dy * step, k * turn);
        const double delta = options_.translation_delta_cost_weight * offset.head<2>().norm() +
                             options_.rotation_delta_cost_weight * std::abs(offset.z());
        const double probability = ProbabilityGrid::value_to_probability(*sum / static_cast<double>(points.size()));
        candidates.push_back({offset, probability * std::exp(-delta * delta)});
        const Candidate& last = candidates.back();
        const bool nearer = best != nullptr && last.score == best->score && last.offset.norm() < best->offset.norm();
        if (best == nullptr || last.score > best->score || nearer) best = &last;
      }
    }
  }
  match.rejection = Rejection::kNone;
  match.evaluations = static_cast<long>(candidates.size());
  match.pose = {guess.x + best->offset.x(), guess.y + best->offset.y(), wrap_angle(guess.theta + best->offset.z())};
  score_pose(grid_, points, match);
  SampleCovariance samples(best->score, points.size());
  for (const Candidate& candidate : candidates) samples.add(candidate.offset - best->offset, candidate.score);
  match.covariance = samples.covariance({step, step, turn});
  match.information = match.covariance.inverse();
  return match;
}

}  // namespace oort
