// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/localization/localizer.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/localization/tuning.hpp"
#include "oort/map/map_check.hpp"
#include "oort/matching/frsm_adapter.hpp"
#include "oort/matching/frsm_setup.hpp"

namespace oort {
namespace {

OdometryModel model_of(const OdometryNoiseParameters& p) {
  return {p.translation_per_meter, p.translation_per_radian, p.rotation_per_meter,
          p.rotation_per_radian,   p.translation_floor,      p.rotation_floor};
}

Eigen::Matrix3d floored(Eigen::Matrix3d covariance) {
  covariance.diagonal() += Eigen::Vector3d(LocalizationTuning::kSigmaFloorXy * LocalizationTuning::kSigmaFloorXy,
                                           LocalizationTuning::kSigmaFloorXy * LocalizationTuning::kSigmaFloorXy,
                                           LocalizationTuning::kSigmaFloorTheta * LocalizationTuning::kSigmaFloorTheta);
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace

std::string_view to_string(LocalizationState state) {
  switch (state) {
    case LocalizationState::kSearching:
      return "searching";
    case LocalizationState::kTracking:
      return "tracking";
    case LocalizationState::kUncertain:
      return "uncertain";
    case LocalizationState::kLost:
      return "lost";
  }
  return "unknown";
}

Localizer::Localizer(std::shared_ptr<const ReferenceMap> map, const Parameters& parameters, const Pose2& T_base_sensor)
    : map_(std::move(map)),
      parameters_(parameters.localization.tracking),
      kept_parameters_(parameters.localization.relocalizer),
      min_points_(parameters.min_pointcloud_size),
      lasers_(parameters, T_base_sensor),
      T_base_sensor_(T_base_sensor),
      odometry_model_(model_of(parameters.incremental_graph_builder.odometry_noise)),
      matcher_(matcher_params(parameters.incremental_graph_builder.frsm_matcher)),
      relocalizer_(map_, parameters),
      views_(kept_parameters_.scan_distance, kept_parameters_.scan_angle,
             std::max(LocalizationTuning::kRememberedViews, static_cast<std::size_t>(kept_parameters_.max_scans))) {
  check_reach(T_base_sensor, "the sensor's pose on the base", "check the transform");
}

void Localizer::start_at(const Pose2& T_map_sensor, const Eigen::Matrix3d& covariance) {
  check_reach(T_map_sensor, "localisation: the start pose");
  if (!covariance.allFinite() || Eigen::LLT<Eigen::Matrix3d>(covariance).info() != Eigen::Success) {
    throw InputError("localisation: the start pose's covariance is not positive definite");
  }
  start_searching();
  T_map_sensor_ = T_map_sensor;
  covariance_ = covariance;
  was_relied_on_ = true;
  T_odom_sensor_.reset();
  state_ = LocalizationState::kUncertain;
}

void Localizer::start_searching() {
  forget_pose();
  views_.clear();
}

void Localizer::forget_pose() {
  T_map_sensor_.reset();
  is_seen_ = was_relied_on_ = false;
  rival_.reset();
  probation_ = 0.0;
  doubtful_travel_ = 0.0;
  doubtful_scans_ = 0;
  state_ = LocalizationState::kSearching;
}

LocalizationState Localizer::add_scan(const LaserScan& scan, const Pose2& T_odom_base, const Sweep& sweep_of_base) {
  check_reach(T_odom_base, "localisation: the odometry pose", "check the transform odom -> base");
  PlacedScan now{lasers_.take(scan, T_odom_base, sweep_of_base), T_odom_base * T_base_sensor_};
  ++statistics_.scans;
  predict(now.T_odom_sensor);
  const bool sees = count_returns(now.cloud) >= static_cast<std::size_t>(min_points_);
  if (T_map_sensor_ && sees) follow(now.cloud);
  state_ = judge();
  if (state_ == LocalizationState::kTracking) was_relied_on_ = true;
  const bool is_new_view = sees && views_.add(now);
  if (state_ != LocalizationState::kTracking && is_new_view) search(now);
  return state_;
}

std::optional<Pose2> Localizer::T_map_sensor() const {
  return T_odom_sensor_ ? T_map_sensor_ : std::nullopt;
}

std::optional<Pose2> Localizer::T_map_odom() const {
  if (!T_map_sensor_ || !T_odom_sensor_) return std::nullopt;
  return *T_map_sensor_ * inverse(*T_odom_sensor_);
}

void Localizer::predict(const Pose2& T_odom_sensor) {
  if (T_map_sensor_ && T_odom_sensor_) {
    const Pose2 motion = between(*T_odom_sensor_, T_odom_sensor);
    const bool stands = motion.x == 0.0 && motion.y == 0.0 && motion.theta == 0.0;
    if (!stands) {
      OdometryModel model = odometry_model_;  // the floors are of an edge between nodes, not of every scan
      model.translation_floor = model.rotation_floor = 0.0;
      covariance_ = compound_covariance(*T_map_sensor_, covariance_, motion, model.covariance(motion));
      T_map_sensor_ = *T_map_sensor_ * motion;
      doubtful_travel_ += motion.translation().norm();
      travel_ += motion.translation().norm();
    }
  }
  T_odom_sensor_ = T_odom_sensor;
}

void Localizer::follow(const PointCloud& cloud) {
  Rejection rejection = Rejection::kNone;
  const std::optional<Hypothesis> found = match(cloud, rejection);
  if (!found) {
    ++statistics_.match_rejections[rejection];
    doubtful_scans_ +=
        support_ < LocalizationTuning::kMinUnexplainedSupport ? LocalizationTuning::kContradictionCounts : 1;
    return;
  }
  ++statistics_.matched;
  const bool innovation = is_seen_ && has_innovation(*found);
  T_map_sensor_ = found->T_map_sensor;
  is_seen_ = true;
  covariance_ = floored(found->covariance);
  probation_ = innovation ? parameters_.doubt_distance : probation_ - doubtful_travel_;
  doubtful_travel_ = 0.0;
  doubtful_scans_ = 0;
}

std::optional<Hypothesis> Localizer::match(const PointCloud& cloud, Rejection& rejection) {
  const frsm::Prior prior{to_frsm(*T_map_sensor_), covariance_};
  const auto half_width = [&](int axis, double least, double most) {
    return std::clamp(LocalizationTuning::kWindowSigmas * std::sqrt(prior.covariance(axis, axis)),
                      std::min(least, most), most);
  };
  const frsm::Window window{half_width(0, LocalizationTuning::kMinWindowXy, parameters_.search_window_xy),
                            half_width(1, LocalizationTuning::kMinWindowXy, parameters_.search_window_xy),
                            half_width(2, LocalizationTuning::kMinWindowTheta, parameters_.search_window_theta)};
  const frsm::Match match = matcher_.match(map_->fine(), returns_of(cloud), prior.mean, window, &prior);
  Hypothesis found{from_frsm(match.pose), match.covariance, {}};
  map_->weigh(cloud, found.T_map_sensor, found.support);
  support_ = found.support.value();
  if (!match.usable())
    rejection = rejection_of(match.status);
  else if (support_ < parameters_.min_support)
    rejection = Rejection::kLowSupport;
  else if (!is_expected(found))
    rejection = Rejection::kUnexpected;
  else if (contradicts_memory(found))
    rejection = Rejection::kContradictsEarlierViews;
  return rejection == Rejection::kNone ? std::optional<Hypothesis>(found) : std::nullopt;
}

bool Localizer::is_expected(const Hypothesis& found) const {
  const Eigen::Vector3d d(found.T_map_sensor.x - T_map_sensor_->x, found.T_map_sensor.y - T_map_sensor_->y,
                          wrap_angle(found.T_map_sensor.theta - T_map_sensor_->theta));
  return d.dot(floored(covariance_).ldlt().solve(d)) <= LocalizationTuning::kMaxInnovation;
}

bool Localizer::has_innovation(const Hypothesis& found) const {
  const Pose2 moved = between(*T_map_sensor_, found.T_map_sensor);
  return moved.translation().norm() > LocalizationTuning::kInnovationXy ||
         (doubtful_scans_ >= LocalizationTuning::kFewScans &&
          std::abs(moved.theta) > LocalizationTuning::kInnovationTheta);
}

bool Localizer::contradicts_memory(const Hypothesis& found) const {
  if (between(*T_map_sensor_, found.T_map_sensor).translation().norm() <= LocalizationTuning::kJump) return false;
  const auto support_at = [&](const Pose2& T_map_sensor) {
    return views_.weigh(*map_, T_map_sensor * inverse(*T_odom_sensor_)).value();
  };
  return support_at(found.T_map_sensor) < support_at(*T_map_sensor_) - LocalizationTuning::kMuchLessSupport;
}

void Localizer::search(const PlacedScan& scan) {
  ++statistics_.searches;
  const Relocalization found = relocalizer_.find(views_.latest(static_cast<std::size_t>(kept_parameters_.max_scans)));
  if (!found.found()) {
    ++statistics_.search_rejections[found.rejection];
    // An answer that was never relied on came of fewer views: with more of them another place is as good.
    if (T_map_sensor_ && !was_relied_on_ && found.lead() < kept_parameters_.min_lead) forget_pose();
    return;
  }
  if (!T_map_sensor_ || !is_expected(*found.best)) {
    if (!may_jump(*found.best, scan)) return;
    if (T_map_sensor_) ++statistics_.jumps;
    probation_ = parameters_.doubt_distance;
  }
  rival_.reset();
  T_map_sensor_ = found.best->T_map_sensor;
  is_seen_ = true;
  T_odom_sensor_ = scan.T_odom_sensor;
  covariance_ = floored(found.best->covariance);
  support_ = found.best->support.value();
  doubtful_travel_ = 0.0;
  doubtful_scans_ = 0;
  state_ = judge();
}

bool Localizer::may_jump(const Hypothesis& found, const PlacedScan& scan) {
  const bool was_followed = is_seen_ && probation_ <= 0.0;
  if (!was_followed || state_ != LocalizationState::kUncertain) return true;
  const Pose2 T_map_odom = found.T_map_sensor * inverse(scan.T_odom_sensor);
  if (rival_) {
    const Pose2 apart = between(rival_->T_map_odom * scan.T_odom_sensor, found.T_map_sensor);
    const bool agrees = apart.translation().norm() < LocalizationTuning::kRivalXy &&
                        std::abs(apart.theta) < LocalizationTuning::kRivalTheta;
    if (agrees) return travel_ - rival_->way >= LocalizationTuning::kRivalTravel;
  }
  rival_ = Rival{T_map_odom, travel_};
  return false;
}

LocalizationState Localizer::judge() const {
  if (!T_map_sensor_) return LocalizationState::kSearching;
  if (deviation() > parameters_.lost_deviation ||
      doubtful_travel_ > LocalizationTuning::kLostFactor * parameters_.doubt_distance) {
    return LocalizationState::kLost;
  }
  const bool in_doubt = !is_seen_ || probation_ > 0.0 || doubtful_travel_ > parameters_.doubt_distance ||
                        doubtful_scans_ >= LocalizationTuning::kDoubtfulScans;
  return in_doubt || deviation() > parameters_.uncertain_deviation ? LocalizationState::kUncertain
                                                                   : LocalizationState::kTracking;
}

double Localizer::deviation() const {
  const Eigen::Matrix2d position = covariance_.topLeftCorner<2, 2>();
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(position).eigenvalues().maxCoeff());
}

}  // namespace oort
