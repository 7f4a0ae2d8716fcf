// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "frsm/matcher.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "check.hpp"
#include "refine.hpp"
#include "search.hpp"

namespace frsm {
namespace {

constexpr double kPolishReach = 1.5;   // cells and heading steps about the best pose of the lattice
constexpr double kSeparation = 0.3;    // [m] and [rad]; nearer, a second peak is the same one
constexpr double kWidestWindow = 1e6;  // [cells] and [steps] each way
constexpr double kFarthest = 1e6;      // [m]; keeps cell indices far from the limits of int

// Points that fall in one cell are not independent.
std::size_t independent_points(const Points& body, double cell) {
  std::vector<std::pair<long, long>> cells;
  cells.reserve(body.size());
  for (const Point& p : body) cells.emplace_back(std::lround(p.x / cell), std::lround(p.y / cell));
  std::sort(cells.begin(), cells.end());
  return static_cast<std::size_t>(std::unique(cells.begin(), cells.end()) - cells.begin());
}

// The smallest number of steps that reach the half width.
int steps(double half_width, double step) {
  return static_cast<int>(std::ceil(half_width / step - 1e-9));
}

Lattice make_lattice(const Pose& guess, const Window& window, double cell, double theta_step) {
  return {guess, cell, theta_step, steps(window.x, cell), steps(window.y, cell), steps(window.theta, theta_step)};
}

BoundedResult find_best(const Search& search, const MatcherParams& params) {
  const long shifts = (2L * search.lattice.nx + 1) * (2L * search.lattice.ny + 1);
  const long candidates = shifts * (2L * search.lattice.nt + 1);
  if (params.max_tiles > 0 && (shifts > params.exhaustive_limit || candidates > params.max_candidates)) {
    return search_two_level(search, static_cast<std::size_t>(params.max_tiles));
  }
  if (shifts <= params.exhaustive_limit) return {search_all(search), false};
  if (shifts <= params.two_level_limit) return search_two_level(search, std::numeric_limits<std::size_t>::max());
  return {search_bounded(search), false};
}

// Score of the best pose well apart from the best one, as a share of its score; without regard to the prior.
double second_peak(const Search& search, const Candidate& best, const MatcherParams& params) {
  const Lattice& lattice = search.lattice;
  const int cells = steps(kSeparation, lattice.cell);
  const int turns = steps(kSeparation, lattice.theta_step);
  const Search apart{search.table,
                     search.body,
                     lattice,
                     Objective(search.objective.weight(), search.body.size(), nullptr),
                     Exclusion{best, cells, cells, turns},
                     static_cast<std::uint32_t>(std::ceil(params.ambiguity_floor * best.sum)),
                     search.on_lookups};
  const auto second = find_best(apart, params).best;
  return second ? static_cast<double>(second->sum) / best.sum : 0.0;
}

bool on_border(const Lattice& lattice, const Candidate& c) {
  const auto at_end = [](int i, int n) { return n > 0 && std::abs(i) == n; };
  return at_end(c.ix, lattice.nx) || at_end(c.iy, lattice.ny) || at_end(c.it, lattice.nt);
}

void check_input(const Pose& guess, const Window& window, double cell, double theta_step, const Prior* prior) {
  check(is_finite(guess), "the guess", "is not finite");
  check(std::abs(guess.x) <= kFarthest && std::abs(guess.y) <= kFarthest, "the guess",
        "is more than 1000 km from the origin");
  check(window.x >= 0.0 && window.y >= 0.0 && window.theta >= 0.0, "the window", "has a negative half width");
  check(std::max(window.x, window.y) <= kWidestWindow * cell && window.theta <= kWidestWindow * theta_step,
        "the window", "is wider than a million steps");
  if (prior == nullptr) return;
  check(is_finite(prior->mean), "the prior's mean", "is not finite");
  check(prior->covariance.allFinite() && Eigen::LLT<Eigen::Matrix3d>(prior->covariance).info() == Eigen::Success,
        "the prior's covariance", "is not positive definite");
}

// What is known when the scan tells nothing.
Match unmatched(Status status, const Pose& guess, const Window& window, const Prior* prior, double cell,
                double theta_step, std::size_t points) {
  Match match;
  match.status = status;
  match.pose = guess;
  match.points = static_cast<int>(points);
  const Eigen::Vector3d widths(std::max(window.x, cell), std::max(window.y, cell), std::max(window.theta, theta_step));
  match.covariance = prior != nullptr ? prior->covariance : Eigen::Matrix3d(widths.cwiseAbs2().asDiagonal());
  return match;
}

void count_hits(const Table& table, const Points& body, int hit_value, Match* match) {
  double sum = 0.0;
  for (const Point& p : transform(match->pose, body)) {
    const int value = table.value(table.index(p.x), table.index(p.y));
    sum += value;
    if (value >= hit_value) ++match->hits;
  }
  match->points = static_cast<int>(body.size());
  match->inlier_ratio = match->hits / static_cast<double>(body.size());
  match->score = sum / (255.0 * static_cast<double>(body.size()));
}

Status judge(const Match& match, const MatcherParams& params) {
  if (match.inlier_ratio < params.min_inlier_ratio) return Status::kLowHits;
  if (match.saturated) return Status::kSaturated;
  return match.degenerate ? Status::kDegenerate : Status::kOk;
}

}  // namespace

std::string_view to_string(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kEmptyScan:
      return "empty scan";
    case Status::kTooFewPoints:
      return "too few points";
    case Status::kNoOverlap:
      return "no overlap";
    case Status::kSaturated:
      return "saturated";
    case Status::kDegenerate:
      return "degenerate";
    case Status::kLowHits:
      return "low hits";
  }
  return "unknown";
}

void MatcherParams::validate() const {
  check(theta_step > 0.0 && theta_step <= 1.0, "MatcherParams.theta_step", "must be above 0 and at most 1 rad");
  check(hit_value >= 1 && hit_value <= 255, "MatcherParams.hit_value", "must be 1 to 255");
  check(min_points >= 1, "MatcherParams.min_points", "must be at least 1");
  check(min_inlier_ratio >= 0.0 && min_inlier_ratio <= 1.0, "MatcherParams.min_inlier_ratio", "must be 0 to 1");
  check(min_score >= 0.0 && min_score <= 1.0, "MatcherParams.min_score", "must be 0 to 1");
  check(information_scale > 0.0 && std::isfinite(information_scale), "MatcherParams.information_scale",
        "must be above 0");
  check(min_curvature >= 0.0 && min_curvature <= 1.0, "MatcherParams.min_curvature", "must be 0 to 1");
  check(ambiguity_floor > 0.0, "MatcherParams.ambiguity_floor", "must be above 0");
  check(max_candidates >= 1, "MatcherParams.max_candidates", "must be at least 1");
  check(max_tiles >= 0, "MatcherParams.max_tiles", "must not be negative");
  check(two_level_limit >= 0, "MatcherParams.two_level_limit", "must not be negative");
  check(exhaustive_limit >= 1, "MatcherParams.exhaustive_limit", "must be at least 1");
}

Matcher::Matcher(const MatcherParams& params) : params_(params) {
  params_.validate();
}

Match Matcher::match(const Table& table, const Points& body, const Pose& guess, const Window& window,
                     const Prior* prior, const OnLookups& on_lookups) const {
  const double cell = table.params().cell;
  check_input(guess, window, cell, params_.theta_step, prior);
  const Points valid = drop_invalid(body);
  const Points points = within(valid, table.params().radius);
  const auto give_up = [&](Status status) {
    return unmatched(status, guess, window, prior, cell, params_.theta_step, points.size());
  };
  if (valid.empty()) return give_up(Status::kEmptyScan);
  if (points.size() < static_cast<std::size_t>(params_.min_points)) return give_up(Status::kTooFewPoints);
  if (table.empty()) return give_up(Status::kNoOverlap);

  const double weight = params_.information_scale * static_cast<double>(independent_points(points, cell));
  const Search search{table,
                      points,
                      make_lattice(guess, window, cell, params_.theta_step),
                      Objective(weight, points.size(), prior),
                      std::nullopt,
                      static_cast<std::uint32_t>(std::ceil(255.0 * params_.min_score * points.size())),
                      on_lookups};
  const BoundedResult found = find_best(search, params_);
  if (!found.best) return give_up(Status::kLowHits);
  const Candidate& best = *found.best;
  if (best.sum == 0) return give_up(Status::kNoOverlap);

  Match match;
  match.saturated = found.is_cut_short || on_border(search.lattice, best);
  if (params_.ambiguity_floor < 1.0) match.ambiguity = second_peak(search, best, params_);
  match.pose = polish(table, points, search.objective, search.lattice.at(best.it, best.ix, best.iy),
                      {kPolishReach * cell, kPolishReach * cell, kPolishReach * params_.theta_step});
  Shape shape = fit_shape(table, points, match.pose, weight, params_.min_curvature, window);
  match.pose = slide_to_prior(table, points, match.pose, search.objective, guess, &shape);
  count_hits(table, points, params_.hit_value, &match);
  match.evidence = weight * match.score;
  match.information = shape.information;
  match.degenerate = shape.free_directions > 0;
  match.covariance =
      (shape.information + (prior != nullptr ? search.objective.information() : shape.window_information())).inverse();
  match.status = judge(match, params_);
  return match;
}

}  // namespace frsm
