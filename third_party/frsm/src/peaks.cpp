// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "frsm/peaks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <tuple>

#include "check.hpp"
#include "pyramid.hpp"
#include "search.hpp"
#include "slice.hpp"

namespace frsm {
namespace {

constexpr double kWidest = 1e4;                   // [m]
constexpr std::uint64_t kLookupsTold = 1U << 20;  // at once

// A square of shifts at one heading: 2^level from (ix, iy) upwards.
struct Square {
  std::uint32_t sum = 0;  // bounds the sums of its shifts; the sum itself at level 0
  int level = 0, it = 0, ix = 0, iy = 0;

  // Larger sums first; of equal ones the smaller square, so that peaks come out early; the rest only fixes an order.
  bool operator<(const Square& other) const {
    return std::tie(sum, other.level, other.it, other.iy, other.ix) < std::tie(other.sum, level, it, iy, ix);
  }
};

class PeakFinder {
 public:
  PeakFinder(const Table& table, const Points& body, const Lattice& lattice, const PeakParams& params,
             const OnLookups& on_lookups)
      : lattice_(lattice),
        params_(params),
        on_lookups_(on_lookups),
        pyramid_(table.bounds(on_lookups)),
        points_(body.size()) {
    levels_.push_back(table.view());
    const int side = 2 * std::max(lattice_.nx, lattice_.ny) + 1;
    for (int h = 1; h <= pyramid_->top() && (1 << (h - 1)) < side; ++h) levels_.push_back(pyramid_->level(h));
    for (int it = -lattice_.nt; it <= lattice_.nt; ++it) {
      to_cells(table, body, lattice_.at(it, 0, 0), &cells_.emplace_back());
    }
    apart_xy_ = static_cast<int>(std::ceil(params.apart_xy / lattice.cell - 1e-9));
    apart_theta_ = static_cast<int>(std::ceil(params.apart_theta / lattice.theta_step - 1e-9));
    floor_ = static_cast<std::uint32_t>(std::ceil(255.0 * params.floor * static_cast<double>(points_)));
  }

  Peaks run() {
    push_roots();
    Peaks found;
    for (std::size_t expansions = 0; !queue_.empty();) {
      const Square square = queue_.top();
      queue_.pop();
      if (square.sum < floor_) break;
      if (covered(square)) continue;
      if (square.level == 0) {
        if (found.peaks.size() == params_.max_peaks) return unfinished(found);
        found.peaks.push_back(
            {lattice_.at(square.it, square.ix, square.iy), square.sum / (255.0 * static_cast<double>(points_))});
        taken_.push_back(square);
        floor_ = std::max(floor_, static_cast<std::uint32_t>(std::ceil(params_.ratio * taken_.front().sum)));
      } else {
        const bool is_hopeless = found.peaks.empty() && expansions >= params_.max_expansions_to_first;
        if (is_hopeless || ++expansions > params_.max_expansions) return unfinished(found);
        push_quarters(square);
      }
    }
    return found;
  }

 private:
  static Peaks unfinished(Peaks found) {
    found.complete = false;
    return found;
  }

  void push_roots() {
    const int top = static_cast<int>(levels_.size()) - 1;
    for (int it = -lattice_.nt; it <= lattice_.nt; ++it) {
      for (int iy = -lattice_.ny; iy <= lattice_.ny; iy += 1 << top) {
        for (int ix = -lattice_.nx; ix <= lattice_.nx; ix += 1 << top) push(top, it, ix, iy);
      }
    }
  }

  void push_quarters(const Square& square) {
    const int half = 1 << (square.level - 1);
    for (const int iy : {square.iy, square.iy + half}) {
      for (const int ix : {square.ix, square.ix + half}) {
        if (ix <= lattice_.nx && iy <= lattice_.ny) push(square.level - 1, square.it, ix, iy);
      }
    }
  }

  void push(int level, int it, int ix, int iy) {
    count_lookups();
    const std::uint32_t sum = sum_values(levels_[level], cells_[it + lattice_.nt], ix, iy);
    if (sum >= floor_) queue_.push({sum, level, it, ix, iy});
  }

  void count_lookups() {
    lookups_ += points_;
    if (lookups_ < kLookupsTold) return;
    if (on_lookups_) on_lookups_(lookups_);
    lookups_ = 0;
  }

  // Whether all of a square belongs to a peak that was found.
  bool covered(const Square& square) const {
    const int last = (1 << square.level) - 1;
    return std::any_of(taken_.begin(), taken_.end(), [&](const Square& peak) {
      const auto near = [&](int low, int middle) {
        return low >= middle - apart_xy_ && low + last <= middle + apart_xy_;
      };
      return near(square.ix, peak.ix) && near(square.iy, peak.iy) && turns_between(square.it, peak.it) <= apart_theta_;
    });
  }

  int turns_between(int a, int b) const {
    const double angle = std::abs(wrap((a - b) * lattice_.theta_step));
    return static_cast<int>(std::floor(angle / lattice_.theta_step + 1e-9));
  }

  const Lattice& lattice_;
  const PeakParams& params_;
  const OnLookups& on_lookups_;
  std::uint64_t lookups_ = 0;  // not told yet
  std::shared_ptr<const BoundPyramid> pyramid_;
  std::size_t points_;
  std::vector<TableView> levels_;
  std::vector<std::vector<Cell>> cells_;  // per heading
  int apart_xy_ = 0, apart_theta_ = 0;
  std::uint32_t floor_ = 0;
  std::priority_queue<Square> queue_;
  std::vector<Square> taken_;
};

}  // namespace

void PeakParams::validate() const {
  check(theta_step > 0.0 && theta_step <= 1.0, "PeakParams.theta_step", "must be above 0 and at most 1 rad");
  check(floor > 0.0 && floor <= 1.0, "PeakParams.floor", "must be above 0 and at most 1");
  check(ratio > 0.0 && ratio <= 1.0, "PeakParams.ratio", "must be above 0 and at most 1");
  check(apart_xy > 0.0 && apart_theta > 0.0, "PeakParams.apart_xy", "and apart_theta must be above 0");
  check(max_peaks >= 1, "PeakParams.max_peaks", "must be at least 1");
}

Peaks find_peaks(const Table& table, const Points& body, const Pose& middle, const Window& window,
                 const PeakParams& params, const OnLookups& on_lookups) {
  params.validate();
  check(is_finite(middle), "the middle of the window", "is not finite");
  check(window.x >= 0.0 && window.y >= 0.0 && window.theta >= 0.0, "the window", "has a negative half width");
  check(std::max(window.x, window.y) <= kWidest, "the window", "is wider than 10 km");
  const Points points = drop_invalid(body);
  if (points.empty() || table.empty()) return {};
  const double cell = table.params().cell;
  const auto steps = [](double half_width, double step) { return static_cast<int>(std::ceil(half_width / step)); };
  const int half_turn = static_cast<int>(std::floor(M_PI / params.theta_step));
  const Lattice lattice{middle,
                        cell,
                        params.theta_step,
                        steps(window.x, cell),
                        steps(window.y, cell),
                        window.theta >= M_PI ? half_turn : std::min(half_turn, steps(window.theta, params.theta_step))};
  return PeakFinder(table, points, lattice, params, on_lookups).run();
}

}  // namespace frsm
