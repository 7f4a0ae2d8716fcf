// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "oort/geometry/pose2.hpp"

namespace oort {

/// A pose and its time.
struct TimedPose {
  double time = 0.0;  ///< [s]
  Pose2 pose;
};

/// Odometry whose turns are those of a gyro: each step keeps odometry's translation and takes its turn from the
/// integrated yaw rate, less the gyro's bias, which is learned while odometry says that the base stands. A step that
/// the gyro does not cover, over which it is dead, or that comes before the bias is known, keeps odometry's turn
/// (docs/motion.md).
///
/// What comes of it depends on the order of messages within each of the two streams, not on how they mingle, as long as
/// the gyro is no more than a second behind. Messages not newer than the last of their stream are left out, but a rate
/// that is older by more than a second begins the gyro's stream anew: either the last one's stamp was wrong, or the
/// clock was set back. Rates are kept for 20 s.
class GyroOdometry {
 public:
  /// Adds a yaw rate of the base [rad/s], counter-clockwise, at a time [s]. Throws InputError if one is not finite.
  void add_gyro(double time, double yaw_rate);

  /// Adds T_odom_base at a time [s]. Throws InputError if a value is not finite.
  void add_odometry(double time, const Pose2& T_odom_base);

  /// The poses that are settled since the last call, in order: T_odom_base, beginning at odometry's first pose.
  std::vector<TimedPose> take();

  /// Settles what is left, as the gyro tells nothing more.
  void flush();

  /// Odometry's clock was set back to a time [s]: what it tells next goes on from the last pose, and the bias is kept.
  /// Poses that were not taken are gone.
  void set_back(double time);

  /// What the gyro tells while the base stands [rad/s], once it stood for a second.
  std::optional<double> bias() const;

  std::uint64_t steps_by_gyro() const { return steps_by_gyro_; }
  std::uint64_t steps_by_odometry() const { return steps_by_odometry_; }

 private:
  struct Rate {
    double time;
    double value;
  };

  void settle();
  void step(const TimedPose& now);
  void learn_bias(double mean_rate, double duration);
  bool is_silent(const std::optional<double>& turn, double told_by_odometry, double duration);
  std::optional<double> integral(double begin, double end);

  std::deque<Rate> rates_;
  std::deque<TimedPose> waiting_;
  std::vector<TimedPose> settled_;
  std::optional<TimedPose> last_;  // of odometry, as it came
  Pose2 pose_;                     // there, with the gyro's turns
  double newest_odometry_ = -std::numeric_limits<double>::infinity();
  double bias_ = 0.0;
  double learned_ = 0.0;       // time that the bias was learned over [s]
  double contrary_ = 0.0;      // what the gyro tells at rest instead of the bias [rad/s],
  double contrary_for_ = 0.0;  // and for how long it has [s]
  double silent_ = 0.0;        // time that odometry turned and the gyro told of no turn at all [s]
  double still_ = 0.0;         // time that the base has been standing for [s]
  std::uint64_t steps_by_gyro_ = 0;
  std::uint64_t steps_by_odometry_ = 0;
};

}  // namespace oort
