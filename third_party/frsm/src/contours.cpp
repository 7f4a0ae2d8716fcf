// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "frsm/contours.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>

#include "check.hpp"

namespace frsm {
namespace {

constexpr double kStepMargin = 1.1;
// Three points of a wall seen at a grazing angle: of the longer link to the other, and from the line at most.
constexpr double kSpacingRatio = 1.8;
constexpr double kStraight = 0.04;  // [m]
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

struct Link {
  std::size_t to = kNone;
  double length = 0.0;
  bool taken() const { return to != kNone; }
};

struct Node {
  Link left, right;  // to a smaller and to a larger index
};

// (length, point that asks, partner): exact lexicographic order makes the result independent of the heap's insides.
using Proposal = std::tuple<double, std::size_t, std::size_t>;

double angle_between(const Point& a, const Point& b) {
  return std::abs(std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y));
}

// How far beams may be apart that are linked at any distance [rad]: a coarse laser's own step, with some room for a
// scan that was taken while the sensor turned.
double sparse_step(const Points& points, const ContourParams& params) {
  if (points.size() < 2 || params.widest_beam_step <= params.max_beam_step) return params.max_beam_step;
  std::vector<double> steps(points.size() - 1);
  for (std::size_t k = 0; k + 1 < points.size(); ++k) steps[k] = angle_between(points[k], points[k + 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return std::clamp(kStepMargin * *middle, params.max_beam_step, params.widest_beam_step);
}

class Linker {
 public:
  Linker(const Points& points, const ContourParams& params)
      : points_(points), params_(params), beam_step_(sparse_step(points, params)), nodes_(points.size()) {}

  std::vector<Contour> run() {
    for (std::size_t p = 0; p < points_.size(); ++p) {
      propose(p, -1);
      propose(p, +1);
    }
    while (!queue_.empty()) {
      const auto [length, p, q] = queue_.top();
      queue_.pop();
      const int side = q < p ? -1 : +1;
      if (facing(p, side).taken()) continue;
      if (facing(q, -side).taken()) {
        propose(p, side);
      } else if (acceptable(length, nodes_[std::min(p, q)].left, nodes_[std::max(p, q)].right) || is_one_wall(p, q)) {
        facing(p, side) = {q, length};
        facing(q, -side) = {p, length};
      }
    }
    return chains();
  }

 private:
  Link& facing(std::size_t p, int side) { return side < 0 ? nodes_[p].left : nodes_[p].right; }

  // The best free partner on one side, looking outwards from p.
  void propose(std::size_t p, int side) {
    double best = std::numeric_limits<double>::infinity();
    std::size_t partner = kNone;
    for (int k = 1; k <= params_.search_range; ++k) {
      const std::size_t q = p + static_cast<std::size_t>(k) * static_cast<std::size_t>(side);  // wraps below 0
      if (q >= points_.size()) break;
      if (facing(q, -side).taken()) continue;
      const double d = std::hypot(points_[p].x - points_[q].x, points_[p].y - points_[q].y);
      if (d < best && (d < params_.max_adjacent_distance || (k == 1 && is_one_wall(p, q)))) {
        best = d;
        partner = q;
      }
      if (d <= params_.always_accept_distance) break;
    }
    if (partner != kNone) queue_.emplace(best, p, partner);
  }

  // Far away, beams are farther apart than surfaces are from one another near by. Two neighbours see one surface if the
  // line through them is not too steep for their beams, or goes on straight.
  bool is_one_wall(std::size_t p, std::size_t q) const {
    if (p + 1 != q && q + 1 != p) return false;
    const Point& a = points_[p];
    const Point& b = points_[q];
    const double between_beams = angle_between(a, b);
    if (between_beams > beam_step_) return false;
    const double range_a = std::hypot(a.x, a.y);
    const double range_b = std::hypot(b.x, b.y);
    const double step = std::abs(range_a - range_b);
    const double across = between_beams * std::min(range_a, range_b);
    if (step <= params_.max_beam_slope * across) return true;
    if (step > params_.max_straight_slope * across) return false;
    const std::size_t first = std::min(p, q);
    return (first > 0 && is_straight(first - 1)) || (first + 2 < points_.size() && is_straight(first));
  }

  // Whether three neighbours lie on a line, about as far apart: a wall seen at a grazing angle.
  bool is_straight(std::size_t first) const {
    const Point& a = points_[first];
    const Point& b = points_[first + 1];
    const Point& c = points_[first + 2];
    if (std::max(angle_between(a, b), angle_between(b, c)) > beam_step_) return false;
    const Point ab{b.x - a.x, b.y - a.y};
    const Point bc{c.x - b.x, c.y - b.y};
    const double before = std::hypot(ab.x, ab.y);
    const double after = std::hypot(bc.x, bc.y);
    if (std::max(before, after) > kSpacingRatio * std::min(before, after)) return false;
    const double off = std::abs(ab.x * bc.y - ab.y * bc.x) / std::max(before, after);
    return ab.x * bc.x + ab.y * bc.y > 0.0 && off <= kStraight;
  }

  // A long link must continue the spacing of the links beside it: walls seen at a grazing angle do, gaps do not. At the
  // end of a chain one side is enough, or the sparse far end of a corridor would fall apart into dots.
  bool acceptable(double length, const Link& before, const Link& after) const {
    if (length <= params_.always_okay_distance) return true;
    if (!before.taken() && !after.taken()) {
      return length <= std::min(params_.max_first_distance, params_.max_distance_without_ratio);
    }
    return continues(length, before) && continues(length, after);
  }

  bool continues(double length, const Link& beside) const {
    if (!beside.taken()) return true;
    if (beside.length < params_.min_distance_for_ratio) return length <= params_.max_distance_without_ratio;
    return length <= params_.max_distance_ratio * beside.length;
  }

  std::vector<Contour> chains() const {
    std::vector<Contour> contours;
    for (std::size_t p = 0; p < nodes_.size(); ++p) {
      if (nodes_[p].left.taken()) continue;
      contours.emplace_back();
      for (std::size_t q = p; q != kNone; q = nodes_[q].right.to) contours.back().push_back(q);
    }
    return contours;
  }

  const Points& points_;
  const ContourParams& params_;
  const double beam_step_;
  std::vector<Node> nodes_;
  std::priority_queue<Proposal, std::vector<Proposal>, std::greater<>> queue_;
};

}  // namespace

ContourParams ContourParams::utm() {
  ContourParams params;
  params.max_adjacent_distance = 6.0;
  params.max_distance_ratio = 2.0;
  params.search_range = 10;
  return params;
}

ContourParams ContourParams::urg() {
  ContourParams params;
  params.max_adjacent_distance = 0.3;
  params.always_okay_distance = 0.15;
  params.always_accept_distance = 0.05;
  params.max_first_distance = 0.2;
  params.max_distance_ratio = 100.0;
  params.search_range = 8;
  return params;
}

ContourParams ContourParams::sick() {
  return {};
}

void ContourParams::validate() const {
  check(max_adjacent_distance > 0.0, "ContourParams.max_adjacent_distance", "must be above 0 m");
  check(always_okay_distance >= 0.0, "ContourParams.always_okay_distance", "must not be negative");
  check(always_accept_distance >= 0.0, "ContourParams.always_accept_distance", "must not be negative");
  check(max_first_distance >= 0.0, "ContourParams.max_first_distance", "must not be negative");
  check(max_distance_ratio > 0.0, "ContourParams.max_distance_ratio", "must be above 0");
  check(min_distance_for_ratio >= 0.0, "ContourParams.min_distance_for_ratio", "must not be negative");
  check(max_distance_without_ratio >= 0.0, "ContourParams.max_distance_without_ratio", "must not be negative");
  check(max_beam_step >= 0.0, "ContourParams.max_beam_step", "must not be negative");
  check(widest_beam_step >= 0.0, "ContourParams.widest_beam_step", "must not be negative");
  check(max_beam_slope >= 0.0, "ContourParams.max_beam_slope", "must not be negative");
  check(max_straight_slope >= 0.0, "ContourParams.max_straight_slope", "must not be negative");
  check(search_range >= 1, "ContourParams.search_range", "must be at least 1");
}

std::vector<Contour> extract_contours(const Points& points, const ContourParams& params) {
  params.validate();
  return Linker(points, params).run();
}

}  // namespace frsm
