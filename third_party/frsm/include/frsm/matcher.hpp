// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "frsm/table.hpp"
#include "frsm/types.hpp"

namespace frsm {

/// Half widths of the searched box about the guess, along the table's axes.
struct Window {
  double x = 0.0;      ///< [m]
  double y = 0.0;      ///< [m]
  double theta = 0.0;  ///< [rad]
};

/// What is known of the pose before the match: a Gaussian in the table's frame.
struct Prior {
  Pose mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< (x, y, theta), positive definite [m^2, m rad, rad^2]
};

enum class Status {
  kOk,
  kEmptyScan,     ///< no valid point: the pose is the guess
  kTooFewPoints,  ///< fewer points, that are valid and near enough, than asked for: the pose is the guess
  kNoOverlap,     ///< nothing to match against within the window: the pose is the guess
  kSaturated,     ///< the best pose lies on the border of the window: the true one may lie beyond
  kDegenerate,    ///< a direction is not seen by the scan (corridor): there the pose is the prior's, or the guess
  kLowHits,       ///< too few points lie on the map
};

std::string_view to_string(Status status);

struct MatcherParams {
  double theta_step = 0.01;         ///< of the search grid [rad]
  int hit_value = 100;              ///< a point whose cell holds at least this is a hit
  int min_points = 10;              ///< fewer valid points are kTooFewPoints
  double min_inlier_ratio = 0.4;    ///< less is kLowHits
  double min_score = 0.0;           ///< poses that score less are not searched for: none is kLowHits, at the guess
  double information_scale = 10.0;  ///< log-likelihood of one independent point; for 1.5 cm of range noise
  double min_curvature = 0.015;     ///< a direction constrained by less than this share of the points is degenerate
  double ambiguity_floor = 1.0;  ///< look for a second peak of at least this share of the best score; >= 1: do not look
  int exhaustive_limit = 2000;   ///< largest number of shifts per heading that are all tried
  int two_level_limit = 20000;   ///< up to so many, tiles of them are bounded first; above: branch and bound

  /// Where more shifts and headings than this are to be tried in all, tiles of them are bounded first, and so many of
  /// the tiles are searched; 0: the work is not bounded.
  int max_candidates = 20000;
  int max_tiles = 0;

  /// Throws std::invalid_argument that names the field when a value makes no sense.
  void validate() const;
};

struct Match {
  Status status = Status::kOk;
  Pose pose;                  ///< T_table_body
  double score = 0.0;         ///< mean table value under the points, 0..1 of the largest value
  double evidence = 0.0;      ///< log-likelihood of the scan there: information_scale * N_eff * score
  int hits = 0;               ///< points that lie on the map
  int points = 0;             ///< valid points
  double inlier_ratio = 0.0;  ///< hits / points; of the Tracker's, where it is low, among the points that its map knows
  /// Of the match alone (x, y, theta), in the table's axes, from the shape of the score; 0 along degenerate directions.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  /// Positive definite, in the table's axes: the match fused with the prior. Without a prior, degenerate directions
  /// have the window's half width as standard deviation. Where the pose is the guess: the prior's, or the window's.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  bool degenerate = false;
  bool saturated = false;  ///< on the window's border, or found in work that was cut short (max_tiles)
  /// Score of the best pose apart from this one (0.3 m or 0.3 rad away) over this score; may exceed 1 when the prior
  /// decided. 0: none above the floor, or not looked for.
  double ambiguity = 0.0;

  /// True when the pose comes from the match and may be used: kOk and kDegenerate.
  bool usable() const { return status == Status::kOk || status == Status::kDegenerate; }
};

/// Correlative scan matcher: exhaustive search (or branch and bound, same result) on the lattice of the guess, then a
/// continuous polish. Maximises  scale * N_eff * score(T) - 0.5 * |T - prior|^2.  Pure and re-entrant.
class Matcher {
 public:
  explicit Matcher(const MatcherParams& params = {});

  /// `body`: points in the body frame; those that are not finite, or farther away than the table draws
  /// (TableParams.radius), are ignored. `prior` may be null.
  /// Throws std::invalid_argument on a guess or window that is not finite, or a covariance that is not positive
  /// definite.
  Match match(const Table& table, const Points& body, const Pose& guess, const Window& window, const Prior* prior,
              const OnLookups& on_lookups = {}) const;

  const MatcherParams& params() const { return params_; }

 private:
  MatcherParams params_;
};

}  // namespace frsm
