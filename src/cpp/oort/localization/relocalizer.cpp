// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/localization/relocalizer.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/localization/tuning.hpp"
#include "oort/matching/frsm_adapter.hpp"
#include "oort/matching/frsm_setup.hpp"

namespace oort {
namespace {

// One point of each cell of a lattice, the first of them: so near walls do not outweigh far ones.
frsm::Points one_per_cell(const frsm::Points& points, double cell) {
  struct Entry {
    long x, y;
    std::size_t index;
  };
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < points.size(); ++i) {
    entries.push_back({std::lround(points[i].x / cell), std::lround(points[i].y / cell), i});
  }
  const auto key = [](const Entry& e) { return std::pair(e.x, e.y); };
  std::stable_sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) { return key(a) < key(b); });
  entries.erase(
      std::unique(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) { return key(a) == key(b); }),
      entries.end());
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.index < b.index; });
  frsm::Points kept;
  for (const Entry& entry : entries) kept.push_back(points[entry.index]);
  return kept;
}

// So many of the points, evenly spread.
frsm::Points at_most(std::size_t count, const frsm::Points& points) {
  if (points.size() <= count) return points;
  frsm::Points kept;
  for (std::size_t k = 0; k < count; ++k) kept.push_back(points[k * points.size() / count]);
  return kept;
}

// The returns of all scans, as far as a map draws any, in the frame of the newest.
frsm::Points join(const std::vector<PlacedScan>& scans, double reach) {
  frsm::Points points;
  for (const PlacedScan& scan : scans) {
    append_transformed(frsm::within(returns_of(scan.cloud), reach),
                       between(scans.back().T_odom_sensor, scan.T_odom_sensor), points);
  }
  return frsm::drop_invalid(points);
}

double reach_of(const frsm::Points& points) {
  double reach = 0.0;
  for (const frsm::Point& p : points) reach = std::max(reach, std::hypot(p.x, p.y));
  return reach;
}

// Turning by a step moves the farthest point by so much [m].
double theta_step(const frsm::Points& points, double moved) {
  return std::clamp(moved / std::max(reach_of(points), moved), LocalizationTuning::kMinThetaStep,
                    LocalizationTuning::kMaxThetaStep);
}

struct Searched {
  frsm::Pose middle;
  frsm::Window window;
};

Searched searched_on(const GridLimits& limits) {
  const double half_x = 0.5 * limits.width * limits.resolution;
  const double half_y = 0.5 * limits.height * limits.resolution;
  return {{limits.origin_x + half_x, limits.origin_y + half_y, 0.0}, {half_x, half_y, M_PI}};
}

Searched searched_in(const SearchArea& area) {
  return {to_frsm(area.T_map_sensor), {area.xy, area.xy, area.theta}};
}

bool same_place(const Pose2& a, const Pose2& b) {
  const Pose2 d = between(a, b);
  return d.translation().norm() < LocalizationTuning::kPeakSpacing &&
         std::abs(d.theta) < LocalizationTuning::kPeakSpacing;
}

}  // namespace

Relocalizer::Relocalizer(std::shared_ptr<const ReferenceMap> map, const Parameters& parameters)
    : map_(std::move(map)),
      parameters_(parameters.localization.relocalizer),
      min_score_(parameters.loop_closure_graph_builder.branch_and_bound_matcher.global_localization_min_score),
      matcher_(matcher_params(parameters.incremental_graph_builder.frsm_matcher)) {}

Relocalization Relocalizer::find(const std::vector<PlacedScan>& scans, const SearchEffort& effort,
                                 const frsm::OnLookups& on_lookups) const {
  if (scans.empty()) throw InputError("relocalisation: no scan was given");
  for (const PlacedScan& scan : scans) {
    if (!is_finite(scan.T_odom_sensor)) throw InputError("relocalisation: a scan's odometry pose is not finite");
  }
  Relocalization result;
  const frsm::Points points = one_per_cell(join(scans, map_->fine().params().radius), LocalizationTuning::kMatchVoxel);
  if (points.size() < static_cast<std::size_t>(parameters_.min_points)) {
    result.rejection = Rejection::kSearchTooFewPoints;
    return result;
  }
  frsm::Peaks peaks;
  std::vector<Hypothesis> found = hypotheses(scans, points, effort, on_lookups, peaks);
  result.stands_out = !peaks.peaks.empty();
  std::stable_sort(found.begin(), found.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.support.value() > b.support.value(); });
  if (!found.empty()) {
    result.best = found.front();
    const auto second = std::find_if(found.begin(), found.end(), [&](const Hypothesis& h) {
      return !same_place(h.T_map_sensor, found.front().T_map_sensor);
    });
    if (second != found.end()) result.second = *second;
  }
  result.rejection = judge(result, scans.size(), effort, peaks.complete);
  return result;
}

std::vector<Hypothesis> Relocalizer::hypotheses(const std::vector<PlacedScan>& scans, const frsm::Points& points,
                                                const SearchEffort& effort, const frsm::OnLookups& on_lookups,
                                                frsm::Peaks& peaks) const {
  frsm::PeakParams search;
  search.floor = std::max({min_score_, LocalizationTuning::kMinScore, effort.floor});
  search.ratio = effort.ratio;
  search.apart_xy = search.apart_theta = LocalizationTuning::kPeakSpacing;
  search.max_expansions = effort.max_expansions;
  search.max_expansions_to_first = effort.max_expansions_to_first;
  search.max_peaks = effort.max_peaks;
  const frsm::Points sparse = at_most(effort.max_points, one_per_cell(points, LocalizationTuning::kSearchVoxel));
  search.theta_step = theta_step(sparse, effort.turn_cells * map_->coarse().params().cell);
  const Searched searched = effort.area ? searched_in(*effort.area) : searched_on(map_->space().limits());
  peaks = frsm::find_peaks(map_->coarse(), sparse, searched.middle, searched.window, search, on_lookups);
  if (!peaks.complete && !effort.weighs_incomplete) return {};
  const double reach = std::max(LocalizationTuning::kFineReach, 2.0 * map_->coarse().params().cell);
  std::vector<Hypothesis> found;
  for (const frsm::Peak& peak : peaks.peaks) {
    const frsm::Match match =
        matcher_.match(map_->fine(), points, peak.pose, {reach, reach, 2.0 * search.theta_step}, nullptr, on_lookups);
    if (match.hits == 0) continue;
    Hypothesis hypothesis{from_frsm(match.pose), match.covariance, {}};
    for (const PlacedScan& scan : scans) {
      map_->weigh(scan.cloud, hypothesis.T_map_sensor * between(scans.back().T_odom_sensor, scan.T_odom_sensor),
                  hypothesis.support);
    }
    found.push_back(hypothesis);
  }
  return found;
}

double Relocalization::lead() const {
  if (!best || !second) return std::numeric_limits<double>::infinity();
  return best->support.value() - second->support.value();
}

Rejection Relocalizer::judge(const Relocalization& result, std::size_t scans, const SearchEffort& effort,
                             bool complete) const {
  if (!result.best) return complete ? Rejection::kNoMatch : Rejection::kAmbiguous;
  const double best = result.best->support.value();
  if (!complete) return Rejection::kAmbiguous;
  if (best < std::min(parameters_.min_support, effort.min_support)) return Rejection::kSearchLowSupport;
  const double doubt = scans == 1 ? LocalizationTuning::kLoneLead : 1.0;
  if (result.lead() < doubt * parameters_.min_lead) return Rejection::kAmbiguous;
  const Eigen::Matrix2d position = result.best->covariance.topLeftCorner<2, 2>();
  const double widest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(position).eigenvalues().maxCoeff();
  const bool precise = std::sqrt(widest) <= parameters_.max_position_deviation &&
                       std::sqrt(result.best->covariance(2, 2)) <= parameters_.max_heading_deviation;
  return precise ? Rejection::kNone : Rejection::kImprecise;
}

}  // namespace oort
