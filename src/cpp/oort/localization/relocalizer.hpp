// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <frsm/peaks.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/localization/reference_map.hpp"
#include "oort/matching/rejection.hpp"

namespace oort {

/// A scan and where odometry saw it.
struct PlacedScan {
  PointCloud cloud;
  Pose2 T_odom_sensor;
};

/// A place of the map where the scans fit.
struct Hypothesis {
  Pose2 T_map_sensor;                                        ///< of the newest scan
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of its x, y, theta, along the axes of the map
  Support support;
};

struct Relocalization {
  /// kNone; or kSearchTooFewPoints: the scans show too little; kNoMatch: no place of the map fits; kSearchLowSupport:
  /// the best place does not fit well enough; kAmbiguous: another place fits nearly as well, or there are more than can
  /// be told apart; kImprecise: the place is found but along some direction not where exactly.
  Rejection rejection = Rejection::kNoMatch;
  std::optional<Hypothesis> best;    ///< the answer if it was found; what was rejected otherwise
  std::optional<Hypothesis> second;  ///< the next place apart from it, by 0.3 m or 0.3 rad
  bool stands_out = true;            ///< whether the search came upon any place that scores enough

  bool found() const { return rejection == Rejection::kNone; }
  /// By how much the best fits better than the next place, as a difference of support; infinity without another.
  double lead() const;
};

/// Where a place is looked for.
struct SearchArea {
  Pose2 T_map_sensor;   ///< in the middle
  double xy = 0.0;      ///< half width [m]
  double theta = M_PI;  ///< half width [rad]
};

/// What a search may cost at most.
struct SearchEffort {
  std::optional<SearchArea> area;       ///< the whole map at all headings if there is none
  double floor = 0.0;                   ///< places of a lower score are not looked at, whatever the parameters say
  double turn_cells = 1.0;              ///< by which a step of the heading moves the farthest point, at most
  double ratio = 0.75;                  ///< places of less than this share of the best score are no rivals
  std::size_t max_points = 100000;      ///< of the scans, that are looked for everywhere
  std::size_t max_expansions = 150000;  ///< see frsm::PeakParams
  std::size_t max_expansions_to_first = 150000;  ///< the same
  std::size_t max_peaks = 32;                    ///< the same
  double min_support = 1.0;  ///< answers of less support than the parameters ask for are found, too, from here on
  /// Whether places are weighed although the search ended early: the answer is ambiguous anyway.
  bool weighs_incomplete = true;
};

/// Finds the robot on a map without a guess: branch and bound over the whole map and all headings (Hess et al. 2016),
/// then a look at each place that scores nearly as well as the best. Const and re-entrant.
class Relocalizer {
 public:
  Relocalizer(std::shared_ptr<const ReferenceMap> map, const Parameters& parameters);

  /// `scans`: one or a few, oldest first, joined by odometry. The answer is the newest one's pose.
  /// Throws InputError if there is none or a pose is not finite.
  /// `on_lookups` is told now and then how many more table values the search has read.
  Relocalization find(const std::vector<PlacedScan>& scans, const SearchEffort& effort = {},
                      const frsm::OnLookups& on_lookups = {}) const;

 private:
  std::vector<Hypothesis> hypotheses(const std::vector<PlacedScan>& scans, const frsm::Points& points,
                                     const SearchEffort& effort, const frsm::OnLookups& on_lookups,
                                     frsm::Peaks& peaks) const;
  Rejection judge(const Relocalization& result, std::size_t scans, const SearchEffort& effort, bool complete) const;

  std::shared_ptr<const ReferenceMap> map_;
  RelocalizerParameters parameters_;
  double min_score_;  // of a peak on the coarse table
  frsm::Matcher matcher_;
};

}  // namespace oort
