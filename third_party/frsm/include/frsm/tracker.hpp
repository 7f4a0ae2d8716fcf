// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "frsm/contours.hpp"
#include "frsm/history.hpp"
#include "frsm/matcher.hpp"
#include "frsm/seen_space.hpp"
#include "frsm/table.hpp"
#include "frsm/velocity.hpp"

namespace frsm {

/// When a matched scan joins the local map. A scan joins if the match is usable, at least `min_hits` of its points hit,
/// the robot has moved by `min_distance` or `min_angle` since the last one joined, and either it is a key scan or fewer
/// than `hit_threshold` of its points hit.
struct AddRule {
  double hit_threshold = 0.9;  ///< fraction of the points
  double min_hits = 0.4;       ///< fraction of the points
  double key_distance = 0.2;   ///< a key scan is this far from the last one that joined [m]; infinity: never
  double key_angle = 0.2;      ///< or turned by this much [rad]; infinity: never
  double min_distance = 0.03;  ///< [m]; 0: a robot at rest may add scans
  double min_angle = 0.03;     ///< [rad]

  /// The original's rule: a scan joins whenever fewer than `hit_threshold` of its points hit.
  static AddRule by_hits(double hit_threshold);
};

struct TrackerParams {
  TableParams table;
  ContourParams contours;
  MatcherParams matcher;
  AddRule add;
  int max_num_scans = 60;                   ///< K >= 2: see History
  double initial_search_range_xy = 0.1;     ///< smallest half window [m]
  double max_search_range_xy = 0.25;        ///< largest half window [m], at more than 2 Hz without alternatives
  double initial_search_range_theta = 0.1;  ///< [rad]
  double max_search_range_theta = 0.25;     ///< [rad]
  bool stationary_motion_model = false;     ///< without odometry: expect no motion, rather than constant velocity
  double prior_sigma_xy = 0.05;             ///< of the expected pose without odometry [m]
  double prior_sigma_theta = 0.1;           ///< [rad]
  double min_prior_sigma_xy = 0.005;        ///< added to the covariance of the odometry [m]
  double min_prior_sigma_theta = 0.02;      ///< [rad]
  double retry_hits = 0.8;     ///< a match with fewer hits, or on the window's border, is tried again (0: never)
  int max_rejected_scans = 5;  ///< after as many unusable scans in a row a fresh local map starts

  /// Throws std::invalid_argument that names the field when a value makes no sense.
  void validate() const;
};

/// Follows a sensor by matching each scan against a local map of recent scans. Deterministic; not thread-safe.
class Tracker {
 public:
  explicit Tracker(const TrackerParams& params = {});

  /// Matches the next scan. `body`: its points in the body frame, in sensor order; `time` [s]: for the constant
  /// velocity model, and whether the scan before is long ago; `odometry`: the motion since the previous call, if known.
  /// If the match is usable, or saturated with at least `retry_hits`, its pose becomes the tracker's; else the expected
  /// pose does, and match.pose and match.covariance are those of the expectation. matched() tells which.
  /// The first scan after construction, reset() or a fresh start has nothing to match and returns kNoOverlap.
  /// Throws std::invalid_argument on an odometry that is not finite, or whose covariance is not positive semi-definite.
  /// `alternatives`: what the motion may have been instead, where odometry is doubted. Each is tried; another one than
  /// the odometry's is believed only if clearly more points hit. hypothesis() tells which. One that is to be tried only
  /// if the match with the odometry is poor must see all directions with at least `retry_hits`, too.
  Match track(const Points& body, double time, const std::optional<Motion>& odometry,
              const std::vector<Motion>& alternatives = {});

  /// Forgets the local map and starts anew at a pose.
  void reset(const Pose& pose);

  /// Overrules the pose of the last scan, which then does not join the local map (but for the first, which joins
  /// there).
  void set_pose(const Pose& pose);

  const Pose& pose() const { return pose_; }

  /// Whether the last pose came from a match, rather than from the expectation.
  bool matched() const { return matched_; }

  /// Which motion the last pose was found with: 0 is that of the odometry, k the k-th alternative.
  std::size_t hypothesis() const { return hypothesis_; }

  /// The local map that the next scan is matched against, without the last scan, which joins at the next call of
  /// track().
  const Table& table() const { return history_.table(); }

  /// Scans drawn in table().
  int num_scans() const { return history_.num_scans(); }
  /// Scans that joined a local map since construction.
  long added_scans() const { return added_scans_; }
  /// Scans that were tried again with another guess or a wider window.
  long retries() const { return retries_; }
  /// Fresh local maps after max_rejected_scans.
  long restarts() const { return restarts_; }

  const TrackerParams& params() const { return params_; }

 private:
  struct Pending {
    Points body;
    Pose pose;
  };
  void join_pending();
  Prior expect(double time, const std::optional<Motion>& odometry) const;
  Pose predict(double time) const;
  Window window(const Prior& prior, double scale) const;
  Match try_match(const Points& body, const Prior& prior, double widen) const;
  bool is_poor(const Match& match) const;
  bool tells(const Match& match) const;
  bool is_far(const Pose& pose) const;
  void match_by_known(const Points& points, const Prior& prior, Match& match) const;
  void judge_by_known(const Points& body, Match& match) const;
  static bool outweighs(const Match& other, const Match& best, const Prior& expected);
  static bool is_better(const Match& other, const Match& best);
  Match recover(const Points& body, double time, const Prior& expected, bool has_odometry, Match best);
  Match start(const Points& body, double time, const Prior& expected);
  bool should_add(const Match& match) const;
  void remember(const Pose& pose, double time, const Eigen::Matrix3d& drift, bool usable);

  TrackerParams params_;
  Matcher matcher_;
  History history_;
  SeenSpace seen_;  // by the scans of the local map
  Pose pose_;
  Pose last_added_;
  Eigen::Matrix3d drift_ =
      Eigen::Matrix3d::Zero();      // covariance of the motion since the last usable match, table's axes
  std::optional<Pending> pending_;  // joins the local map at the next track() unless overruled
  Velocity velocity_;
  bool matched_ = false;
  std::optional<double> last_time_;  // of the last scan [s]
  bool is_unusual_ = false;          // whether the scan before is long ago, or odometry is doubted
  std::size_t hypothesis_ = 0;
  int rejected_ = 0;  // unusable scans in a row
  long added_scans_ = 0;
  long retries_ = 0;
  long restarts_ = 0;
};

}  // namespace frsm
