// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/matching/fast_correlative_matcher.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "oort/geometry/errors.hpp"
#include "oort/matching/grid_score.hpp"
#include "oort/matching/tuning.hpp"

namespace oort {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Poses at one heading, of which the shifts of those that see nothing of the grid are left out: from `low` to `high`
/// cells, both included.
struct Heading {
  double offset;  // from the guess [rad]
  std::vector<CellIndex> cells;
  CellIndex low;
  CellIndex high;
};

/// A box of 2^level by 2^level shifts at one heading, from (dx, dy) on, of which none scores more than `bound`. Of
/// level 0 the bound is the score itself.
struct Box {
  std::size_t heading;
  int dx;
  int dy;
  double bound;
};

bool better(const Box& a, const Box& b) {
  return a.bound > b.bound;
}

}  // namespace

struct FastCorrelativeMatcher::Search {
  const BoundGrids& grids;
  const std::vector<Heading>& headings;
  Box best;
  bool found = false;
  long evaluations = 0;

  Box bounded(std::size_t heading, int dx, int dy, int level) {
    const BoundGrid& bounds = grids.level(level);
    unsigned sum = 0;
    for (const CellIndex& cell : headings[heading].cells) sum += bounds.value(cell.x() + dx, cell.y() + dy);
    ++evaluations;
    const auto points = static_cast<double>(headings[heading].cells.size());
    return {heading, dx, dy, BoundGrid::to_probability(sum / points)};
  }

  /// Every box of the highest level.
  std::vector<Box> roots() {
    const int level = grids.depth() - 1;
    std::vector<Box> boxes;
    for (std::size_t k = 0; k < headings.size(); ++k) {
      for (int dy = headings[k].low.y(); dy <= headings[k].high.y(); dy += 1 << level) {
        for (int dx = headings[k].low.x(); dx <= headings[k].high.x(); dx += 1 << level) {
          boxes.push_back(bounded(k, dx, dy, level));
        }
      }
    }
    std::stable_sort(boxes.begin(), boxes.end(), better);
    return boxes;
  }

  /// Looks for poses better than the best so far in boxes that are sorted by their bounds.
  template <class Boxes>
  void branch(const Boxes& boxes, std::size_t count, int level) {
    for (std::size_t i = 0; i < count && boxes[i].bound > best.bound; ++i) {
      if (level == 0) {
        best = boxes[i];
        found = true;
        return;  // the others score no more
      }
      const int half = 1 << (level - 1);
      const Heading& heading = headings[boxes[i].heading];
      std::array<Box, 4> parts;
      std::size_t parts_count = 0;
      for (const int dy : {boxes[i].dy, boxes[i].dy + half}) {
        for (const int dx : {boxes[i].dx, boxes[i].dx + half}) {
          if (dx > heading.high.x() || dy > heading.high.y()) continue;
          parts[parts_count++] = bounded(boxes[i].heading, dx, dy, level - 1);
        }
      }
      std::stable_sort(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(parts_count), better);
      branch(parts, parts_count, level - 1);
    }
  }
};

namespace {

std::vector<Heading> headings_of(const Points& points, const Pose2& guess, const GridLimits& limits, double turn,
                                 double linear_window, double angular_window) {
  const int turns = static_cast<int>(std::ceil(std::min(angular_window, kPi) / turn));
  const int shifts = static_cast<int>(std::ceil(linear_window / limits.resolution));
  const CellIndex size(limits.width, limits.height);
  std::vector<Heading> headings;
  for (int k = -turns; k <= turns; ++k) {
    const double offset = k * turn;
    Heading heading{offset, cells_of(points, {guess.x, guess.y, guess.theta + offset}, limits), {}, {}};
    CellIndex least = heading.cells.front();
    CellIndex most = least;
    for (const CellIndex& cell : heading.cells) {
      least = least.min(cell);
      most = most.max(cell);
    }
    heading.low = (-most).max(-shifts);
    heading.high = (size - 1 - least).min(shifts);
    headings.push_back(std::move(heading));
  }
  return headings;
}

}  // namespace

FastCorrelativeMatcher::FastCorrelativeMatcher(std::shared_ptr<const BoundGrids> grids,
                                               const FastCorrelativeOptions& options)
    : grids_(std::move(grids)), options_(options) {
  const auto check = [](double window, const char* name) {
    if (!(window >= 0.0) || !std::isfinite(window)) {
      throw ParameterError(std::string("branch and bound: ") + name + " must be a width, not " +
                           std::to_string(window));
    }
  };
  check(options.linear_search_window, "linear_search_window");
  check(options.angular_search_window, "angular_search_window");
}

ScanMatch FastCorrelativeMatcher::match(const Points& points, const Pose2& guess) const {
  check_guess(guess);
  ScanMatch match;
  match.pose = guess;
  if (points.empty()) return match;
  const GridLimits& limits = grids_->grid().limits();
  const double turn = angular_step(points, limits.resolution);
  const std::vector<Heading> headings =
      headings_of(points, guess, limits, turn, options_.linear_search_window, options_.angular_search_window);
  Search search{*grids_, headings, {0, 0, 0, options_.min_score}};
  const std::vector<Box> roots = search.roots();
  search.branch(roots, roots.size(), grids_->depth() - 1);
  match.evaluations = search.evaluations;
  match.rejection = search.found ? Rejection::kNone : Rejection::kLowScore;
  if (!search.found) return match;
  match.pose = {guess.x + search.best.dx * limits.resolution, guess.y + search.best.dy * limits.resolution,
                wrap_angle(guess.theta + headings[search.best.heading].offset)};
  describe(points, turn, match);
  return match;
}

void FastCorrelativeMatcher::describe(const Points& points, double turn, ScanMatch& match) const {
  const ProbabilityGrid& grid = grids_->grid();
  const double step = grid.limits().resolution;
  score_pose(grid, points, match);
  SampleCovariance samples(match.score, points.size());
  for (int k = -MatchingTuning::kCovarianceSteps; k <= MatchingTuning::kCovarianceSteps; ++k) {
    for (int j = -MatchingTuning::kCovarianceSteps; j <= MatchingTuning::kCovarianceSteps; ++j) {
      for (int i = -MatchingTuning::kCovarianceSteps; i <= MatchingTuning::kCovarianceSteps; ++i) {
        const Eigen::Vector3d offset(i * step, j * step, k * turn);
        ScanMatch sample;
        sample.pose = {match.pose.x + offset.x(), match.pose.y + offset.y(), match.pose.theta + offset.z()};
        score_pose(grid, points, sample);
        samples.add(offset, sample.score);
      }
    }
  }
  match.covariance = samples.covariance({step, step, turn});
  match.information = match.covariance.inverse();
}

}  // namespace oort
