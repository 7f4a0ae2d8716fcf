// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "frsm/tracker.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "check.hpp"

namespace frsm {
namespace {

constexpr double kWindowSigmas = 3.0;
constexpr double kWorthwhileHits = 0.02;  // another guess must bring this many more hits to be believed
constexpr double kRetryWindow = 3.0;      // the last try's window, and its prior's standard deviations twice as wide
constexpr double kRetryPrior = 2.0;
// The limits on the window are those of a usual rate of scans, where a larger motion is a fault of odometry. Of scans
// farther apart than this it is none, and where odometry is doubted it is no limit: there the limits are wider.
constexpr double kLongInterval = 0.5;     // [s]
constexpr double kWideWindow = 0.3;       // [m]
constexpr double kWideWindowTheta = 0.5;  // [rad]
// Wider windows cost more than a scan may: with kMaxTiles the worst scan of 360 points takes about 10 ms in all.
constexpr double kWidestWindow = 2.0;       // [m]
constexpr double kWidestWindowTheta = 1.0;  // [rad]
constexpr int kMaxTiles = 1000;
constexpr int kMaxCandidates = 150000;  // all are tried: cheaper than tiles up to there
// A match that leads elsewhere than the odometry, tried as the first one is poor, must be so many times likelier (as a
// logarithm) as odometry is seldom wrong. Looked at on sparse logs of Radish.
constexpr double kFault = 12.0;
// Points where no scan of the local map could see: what they count for the likelihood, of 1 for a point on the map, and
// the least share of the others, and of hits among these, by which a match with few hits in all may be judged.
constexpr double kUnknownValue = 0.5;
constexpr double kLeastKnown = 0.2;
constexpr double kKnownHits = 0.6;
constexpr int kTellingHits = 4;  // times the fewest points that are matched
// A scan that is so many times the motion of a key scan from the last one of the local map sees much that is new, and
// is matched once more, within this of its pose, without that. Looked at on three sparse logs of Radish.
constexpr double kFar = 2.0;
constexpr Window kNearby{0.08, 0.08, 0.04};

Eigen::Matrix3d diagonal(double sigma_xy, double sigma_theta) {
  const Eigen::Vector3d variances(sigma_xy * sigma_xy, sigma_xy * sigma_xy, sigma_theta * sigma_theta);
  return variances.asDiagonal();
}

MatcherParams bounded(MatcherParams params) {
  params.max_tiles = kMaxTiles;
  params.max_candidates = kMaxCandidates;
  return params;
}

void check_motion(const Motion& motion) {
  check(is_finite(motion.delta), "the odometry", "is not finite");
  const Eigen::Matrix3d& c = motion.covariance;
  // A unit of rounding above zero, so that an exact odometry (zero covariance) passes.
  const Eigen::Matrix3d raised = c + (1e-9 * c.diagonal().cwiseAbs().maxCoeff() + 1e-15) * Eigen::Matrix3d::Identity();
  check(c.allFinite() && Eigen::LLT<Eigen::Matrix3d>(raised).info() == Eigen::Success, "the odometry's covariance",
        "is not positive semi-definite");
}

}  // namespace

AddRule AddRule::by_hits(double hit_threshold) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  return {hit_threshold, 0.0, kNever, kNever, 0.0, 0.0};
}

Tracker::Tracker(const TrackerParams& params)
    : params_((params.validate(), params)),
      matcher_(bounded(params.matcher)),
      history_(params.table, params.max_num_scans) {}

void TrackerParams::validate() const {
  table.validate();
  contours.validate();
  matcher.validate();
  check(max_num_scans >= 2, "TrackerParams.max_num_scans", "must be at least 2");
  check(initial_search_range_xy >= 0.0 && initial_search_range_xy <= max_search_range_xy,
        "TrackerParams.initial_search_range_xy", "must be 0 to max_search_range_xy");
  check(initial_search_range_theta >= 0.0 && initial_search_range_theta <= max_search_range_theta,
        "TrackerParams.initial_search_range_theta", "must be 0 to max_search_range_theta");
  check(max_search_range_xy <= 10.0, "TrackerParams.max_search_range_xy", "must be at most 10 m");
  check(max_search_range_theta <= 4.0, "TrackerParams.max_search_range_theta", "must be at most 4 rad");
  check(prior_sigma_xy > 0.0 && prior_sigma_theta > 0.0, "TrackerParams.prior_sigma", "must be above 0");
  check(min_prior_sigma_xy > 0.0 && min_prior_sigma_theta > 0.0, "TrackerParams.min_prior_sigma", "must be above 0");
  check(max_rejected_scans >= 1, "TrackerParams.max_rejected_scans", "must be at least 1");
}

Match Tracker::track(const Points& body, double time, const std::optional<Motion>& odometry,
                     const std::vector<Motion>& alternatives) {
  if (odometry) check_motion(*odometry);
  for (const Motion& alternative : alternatives) check_motion(alternative);
  check(std::isfinite(time), "the time of a scan", "is not finite");
  join_pending();
  Prior expected = expect(time, odometry);
  hypothesis_ = 0;
  const auto always = [](const Motion& motion) { return !motion.only_if_poor; };
  is_unusual_ = std::any_of(alternatives.begin(), alternatives.end(), always) ||
                (last_time_ && time - *last_time_ > kLongInterval);
  last_time_ = time;
  if (history_.table().empty()) return start(body, time, expected);
  Match match = try_match(body, expected, 1.0);
  for (std::size_t k = 0; k < alternatives.size(); ++k) {
    const bool is_last_resort = alternatives[k].only_if_poor;
    if (is_last_resort && !is_poor(match)) continue;
    const Prior other = expect(time, alternatives[k]);
    const Match tried = try_match(body, other, 1.0);
    const bool better = is_last_resort ? tells(tried) && outweighs(tried, match, expected) : is_better(tried, match);
    if (!better) continue;
    match = tried;
    expected = other;
    hypothesis_ = k + 1;
  }
  match = recover(body, time, expected, odometry.has_value(), match);
  // On the window's border but with good hits, the pose is still the best known; it must not shape the map, though.
  const bool good = match.inlier_ratio >= params_.retry_hits;
  // After a gap, a few hits among few points say little: what is seen may lie where the local map shows nothing.
  const bool told = good || match.hits >= kTellingHits * params_.matcher.min_points || drift_.isZero(0.0);
  const bool usable = (match.usable() && told) || (match.status == Status::kSaturated && good);
  matched_ = usable;
  if (usable) {
    if (match.usable() && should_add(match)) pending_ = Pending{drop_invalid(body), match.pose};
  } else {
    match.pose = expected.mean;
    match.covariance = expected.covariance;
    match.information.setZero();
    const bool seen = match.status != Status::kEmptyScan && match.status != Status::kTooFewPoints;
    if (seen && ++rejected_ >= params_.max_rejected_scans) {  // a blind moment says nothing against the map
      ++restarts_;
      history_.clear();
      seen_.clear();
      return start(body, time, expected);
    }
  }
  // After a gap, a match that leaves a direction open has not told where the sensor is.
  const bool located = usable && (!match.degenerate || drift_.isZero(0.0));
  remember(match.pose, time, located ? Eigen::Matrix3d(Eigen::Matrix3d::Zero()) : match.covariance, usable);
  return match;
}

void Tracker::reset(const Pose& pose) {
  check(is_finite(pose), "the pose", "is not finite");
  history_.clear();
  seen_.clear();
  pending_.reset();
  velocity_.clear();
  drift_.setZero();
  pose_ = pose;
  rejected_ = 0;
}

void Tracker::set_pose(const Pose& pose) {
  check(is_finite(pose), "the pose", "is not finite");
  if (pending_ && history_.table().empty()) {
    pending_->pose = pose;  // the first scan carries the map, wherever it is
  } else {
    pending_.reset();
  }
  velocity_.replace_last(pose);
  pose_ = pose;
}

// The first scan of a local map: there is nothing to match it against.
Match Tracker::start(const Points& body, double time, const Prior& expected) {
  Match match;
  Points points = drop_invalid(body);
  matched_ = false;
  match.pose = expected.mean;
  match.points = static_cast<int>(points.size());
  match.covariance = expected.covariance;
  match.status = Status::kNoOverlap;
  if (points.empty()) {
    match.status = Status::kEmptyScan;
  } else if (match.points < params_.matcher.min_points) {
    match.status = Status::kTooFewPoints;
  } else {
    pending_ = Pending{std::move(points), match.pose};
  }
  const bool located = pending_.has_value();
  remember(match.pose, time, located ? Eigen::Matrix3d(Eigen::Matrix3d::Zero()) : expected.covariance, located);
  return match;
}

void Tracker::join_pending() {
  if (!pending_) return;
  const Pending scan = std::move(*pending_);
  pending_.reset();
  const bool is_sparse = !history_.table().empty() && is_far(scan.pose);
  history_.add(transform(scan.pose, scan.body), extract_contours(scan.body, params_.contours), scan.pose, is_sparse);
  seen_.add(scan.body, scan.pose, static_cast<std::size_t>(history_.num_scans()));
  last_added_ = scan.pose;
  ++added_scans_;
}

Prior Tracker::expect(double time, const std::optional<Motion>& odometry) const {
  Prior prior;
  if (odometry) {
    prior.mean = pose_ * odometry->delta;
    prior.covariance = drift_ + rotate_covariance(odometry->covariance, pose_.theta) +
                       diagonal(params_.min_prior_sigma_xy, params_.min_prior_sigma_theta);
  } else {
    prior.mean = predict(time);
    prior.covariance = drift_ + diagonal(params_.prior_sigma_xy, params_.prior_sigma_theta);
  }
  return prior;
}

// Where the last motion leads, bounded by the largest search ranges.
Pose Tracker::predict(double time) const {
  if (params_.stationary_motion_model) return pose_;
  const Pose motion = velocity_.motion_until(time);
  const auto bounded = [](double value, double limit) { return std::clamp(value, -limit, limit); };
  return pose_ * Pose{bounded(motion.x, params_.max_search_range_xy), bounded(motion.y, params_.max_search_range_xy),
                      bounded(motion.theta, params_.max_search_range_theta)};
}

// The limits are those of one motion: after scans that could not be matched the window also covers their motions, as
// far as bounded work does.
Window Tracker::window(const Prior& prior, double scale) const {
  const auto half = [&](int i, double low, double most) {
    const double high = is_unusual_ ? std::max(most, i < 2 ? kWideWindow : kWideWindowTheta) : most;
    const double unmatched = kWindowSigmas * std::sqrt(drift_(i, i));
    const double width = std::clamp(kWindowSigmas * std::sqrt(prior.covariance(i, i)), low, high + unmatched);
    return std::min(scale * width, std::max(high, i < 2 ? kWidestWindow : kWidestWindowTheta));
  };
  return {half(0, params_.initial_search_range_xy, params_.max_search_range_xy),
          half(1, params_.initial_search_range_xy, params_.max_search_range_xy),
          half(2, params_.initial_search_range_theta, params_.max_search_range_theta)};
}

// A view that turns sees something new at one edge, and each new point would rather lie on the old map: the best pose
// turns too little, always the same way. So points beyond what the last scan of the map saw are left out.
Match Tracker::try_match(const Points& body, const Prior& prior, double widen) const {
  const double turn = wrap(prior.mean.theta - last_added_.theta);
  const auto least = static_cast<std::size_t>(params_.matcher.min_points);
  const Points points = seen_.without_new_edge(drop_invalid(body), turn, least);
  Match match = matcher_.match(history_.table(), points, prior.mean, window(prior, widen), &prior);
  match_by_known(points, prior, match);
  judge_by_known(points, match);
  return match;
}

// Whether a scan there would follow the last one of the local map at a distance.
bool Tracker::is_far(const Pose& pose) const {
  return distance(pose, last_added_) > kFar * params_.add.key_distance ||
         std::abs(wrap(pose.theta - last_added_.theta)) > kFar * params_.add.key_angle;
}

// Each new point would rather lie on an old line, too, which turns the match where more is new on one side. On the
// sparse logs of Radish headings over ten scans err by 0.75 degrees (RMS) instead of 0.96, and by over 3 in 0.4 %
// instead of 1.8.
void Tracker::match_by_known(const Points& points, const Prior& prior, Match& match) const {
  if (!match.usable() || !is_far(match.pose)) return;
  const Points known = seen_.covered(points, match.pose);
  if (known.size() == points.size() || static_cast<int>(known.size()) < kTellingHits * params_.matcher.min_points)
    return;
  const Match again = matcher_.match(history_.table(), known, match.pose, kNearby, &prior);
  if (!again.usable()) return;
  match.pose = again.pose;
  match.information = again.information;
  match.covariance = again.covariance;
  match.degenerate = again.degenerate;
  match.status = again.status;
}

// Whether another match is better than the best one: clearly more points hit, or it is free of the window's border.
bool Tracker::is_better(const Match& other, const Match& best) {
  const bool freed = best.saturated && !other.saturated && other.inlier_ratio >= best.inlier_ratio;
  return freed || other.inlier_ratio > best.inlier_ratio + kWorthwhileHits;
}

bool Tracker::is_poor(const Match& match) const {
  return match.status == Status::kNoOverlap ||
         (match.points >= params_.matcher.min_points && (match.saturated || match.inlier_ratio < params_.retry_hits));
}

bool Tracker::tells(const Match& match) const {
  return match.status == Status::kOk && match.inlier_ratio >= params_.retry_hits;
}

// Whether it is better by more than what speaks for the odometry. Without that, as good a match is found by chance
// wherever the window is wide enough.
bool Tracker::outweighs(const Match& other, const Match& best, const Prior& expected) {
  const Eigen::Matrix3d information = expected.covariance.inverse();
  const auto unlikelihood = [&](const Match& match) {
    const Eigen::Vector3d d(match.pose.x - expected.mean.x, match.pose.y - expected.mean.y,
                            wrap(match.pose.theta - expected.mean.theta));
    return std::min(0.5 * d.dot(information * d), kFault);
  };
  return is_better(other, best) && other.evidence - unlikelihood(other) > best.evidence - unlikelihood(best);
}

// Odometry freezes and jumps at times. A poor match is tried again where the robot would be if it had kept its
// velocity, then in a wider window.
Match Tracker::recover(const Points& body, double time, const Prior& expected, bool has_odometry, Match best) {
  if (params_.retry_hits <= 0.0 || !is_poor(best)) return best;
  ++retries_;
  const auto consider = [&](const Match& other) {
    if (outweighs(other, best, expected)) best = other;
  };
  if (has_odometry && !params_.stationary_motion_model) {
    consider(
        try_match(body, {predict(time), drift_ + diagonal(params_.prior_sigma_xy, params_.prior_sigma_theta)}, 1.0));
  }
  if (is_poor(best)) {
    consider(try_match(body, {expected.mean, kRetryPrior * kRetryPrior * expected.covariance}, kRetryWindow));
  }
  return best;
}

// What lies where no scan of the local map could see says nothing for or against it: a robot that comes around a
// corner, or drives backwards, far from one scan to the next, sees mostly new walls. Of a match with few hits only the
// points count that the map could show, if these are enough.
void Tracker::judge_by_known(const Points& points, Match& match) const {
  if (match.hits < params_.matcher.min_points || match.inlier_ratio >= params_.retry_hits) return;
  const Table& table = history_.table();
  int all = 0, known = 0, hits = 0;
  double sum = 0.0;
  for (const Point& p : points) {
    if (std::hypot(p.x, p.y) > params_.table.radius) continue;
    ++all;
    const Point world = match.pose * p;
    if (!seen_.covers(world)) {
      sum += kUnknownValue;
      continue;
    }
    ++known;
    const int value = table.value(table.index(world.x), table.index(world.y));
    sum += value / 255.0;
    if (value >= params_.matcher.hit_value) ++hits;
  }
  if (match.score > 0.0) match.evidence *= sum / (all * match.score);
  if (known < std::max(static_cast<double>(kTellingHits * params_.matcher.min_points), kLeastKnown * all)) return;
  const double ratio = hits / static_cast<double>(known);
  if (match.status == Status::kLowHits) {
    if (ratio < kKnownHits) return;
    match.status = match.saturated ? Status::kSaturated : match.degenerate ? Status::kDegenerate : Status::kOk;
  }
  match.inlier_ratio = std::max(match.inlier_ratio, ratio);
}

bool Tracker::should_add(const Match& match) const {
  const AddRule& rule = params_.add;
  if (match.inlier_ratio < rule.min_hits) return false;
  const double moved = distance(match.pose, last_added_);
  const double turned = std::abs(wrap(match.pose.theta - last_added_.theta));
  if (moved < rule.min_distance && turned < rule.min_angle) return false;
  return moved >= rule.key_distance || turned >= rule.key_angle || match.inlier_ratio < rule.hit_threshold;
}

void Tracker::remember(const Pose& pose, double time, const Eigen::Matrix3d& drift, bool usable) {
  velocity_.add(pose, time);
  pose_ = pose;
  if (usable) rejected_ = 0;
  drift_ = drift;
}

}  // namespace frsm
