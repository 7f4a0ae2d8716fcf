// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace oort {

/// Constants of odometry and gyro that were chosen, not derived (docs/tracking.md, docs/motion.md).
struct OdometryTuning {
  // The span of motion that an extrapolation continues: over a shorter one the noise of stamps and poses counts too
  // much, over a longer one it is not how the base moves now.
  static constexpr double kMinSpan = 0.05;  ///< [s]
  static constexpr double kMaxSpan = 0.5;   ///< [s]

  // Gyro: queues.
  static constexpr double kPatience = 1.0;  ///< [s] that odometry waits for a gyro that is behind
  static constexpr double kSetBack = 1.0;   ///< [s] by which a message is older than the last if the clock was set back
  static constexpr double kKeptRates = 20.0;  ///< [s] of rates that are kept while no odometry comes
  static constexpr double kMaxRateGap = 0.1;  ///< [s] between two rates; over a longer one the turn is not known

  // Gyro: the base stands if wheels tell of less; wheels that stand are seen at rest, but for noise of stamps and of
  // encoders.
  static constexpr double kStandingSpeed = 0.005;  ///< [m/s]
  static constexpr double kStandingTurn = 0.005;   ///< [rad/s]
  static constexpr double kSettling = 0.5;         ///< [s] that it takes to come to rest

  // Gyro: its bias, a mean over the time that the base stood.
  static constexpr double kMinLearned = 1.0;      ///< [s] until it is used
  static constexpr double kMaxLearned = 60.0;     ///< [s]; a bias drifts with the gyro's temperature
  static constexpr double kMaxBias = 0.2;         ///< [rad/s]; more is a robot that somebody turns
  static constexpr double kMaxBiasChange = 0.05;  ///< [rad/s], the same once the bias is known

  // Gyro: a bias learned wrong, as the robot was turned by hand or the gyro warmed up. What it tells at rest instead
  // for so long, and as evenly as no hand turns, is the bias.
  static constexpr double kRelearning = 5.0;  ///< [s]
  static constexpr double kEvenness = 0.05;   ///< [rad/s]

  // Gyro: one that says exactly "no turn" for so long while odometry turns is broken: a sound one has noise.
  static constexpr double kDead = 1.0;     ///< [s]
  static constexpr double kNoTurn = 1e-6;  ///< [rad/s]

  // The learned noise model: it counts as so many steps at first, and the newest step as one of so many later on.
  static constexpr int kInitialSteps = 10;
  static constexpr int kMaxSteps = 100;
  // A single step says no more than this about the variance: a slip of the wheels is not how they always are.
  static constexpr double kMaxVarianceRatio = 25.0;  ///< of one step to the model
  static constexpr double kMaxVarianceFactor = 9.0;  ///< on the model's variances

  // The learned scales: believed to be 1 as much as after so many squared metres and radians of steps, and held near
  // it.
  static constexpr double kInitialTranslations = 1.0;  ///< [m^2]
  static constexpr double kInitialRotations = 2.0;     ///< [rad^2]
  static constexpr double kMaxTranslations = 10.0;     ///< [m^2] that count later on
  static constexpr double kMaxRotations = 20.0;        ///< [rad^2]
  static constexpr double kMaxScaleError = 0.1;
  static constexpr double kStraight = 0.2;  ///< [rad]; turning more, the sensor's translation is not the wheels'

  // Faults: what no robot on wheels, and nobody who carries a sensor on foot, exceeds.
  static constexpr double kMaxSpeed = 4.0;              ///< [m/s]
  static constexpr double kMaxTurnRate = 6.0;           ///< [rad/s]
  static constexpr double kMaxAcceleration = 5.0;       ///< [m/s^2]; a robot that brakes hard does 3
  static constexpr double kMaxTurnAcceleration = 15.0;  ///< [rad/s^2]
  // Beside that a change of motion of so much is noise of stamps and readings.
  static constexpr double kMotionSlack = 0.1;       ///< [m]
  static constexpr double kMotionSlackTheta = 0.1;  ///< [rad]

  // Faults: intervals between scans. Farther apart, stamps say nothing of accelerations.
  static constexpr double kMaxInterval = 1.0;         ///< [s]
  static constexpr double kMinInterval = 1e-3;        ///< [s]
  static constexpr std::size_t kUsualIntervals = 15;  ///< of which the mean is the usual one
  static constexpr std::size_t kMinIntervals = 5;     ///< until it is known
  static constexpr double kBurst = 0.7;  ///< of the usual interval; shorter ones are of scans that queued up

  // Without odometry: the base goes on as it moved, but for what wheels and people who carry a sensor do within a
  // scan's interval. Chosen on fr079, Intel and simulated homes.
  static constexpr double kUsualAcceleration = 4.0;      ///< [m/s^2]
  static constexpr double kUsualTurnAcceleration = 8.0;  ///< [rad/s^2]
  static constexpr double kPredictionError = 0.02;       ///< [m], of the last match and of stamps
  static constexpr double kPredictionErrorTheta = 0.02;  ///< [rad]
  static constexpr double kMaxRatio = 2.0;               ///< of an interval to that over which the motion is known
  static constexpr double kUnmatchedVelocity = 0.5;      ///< share that is left after a scan without a match

  // Faults: odometry that says exactly nothing while the robot was faster is frozen, or the robot stopped dead.
  static constexpr double kMoving = 0.15;    ///< [m/s]
  static constexpr double kTurning = 0.2;    ///< [rad/s]
  static constexpr double kNoMotion = 1e-9;  ///< [m, rad]
  // Faults: a match that differs by more from odometry that is doubted, says that it is wrong: of a jump, and, each
  // scan, of a robot that should stand. Matches of a robot at rest differ by some millimetres.
  static constexpr double kJumpError = 0.1;             ///< [m]
  static constexpr double kJumpErrorTheta = 0.1;        ///< [rad]
  static constexpr double kStandingError = 0.015;       ///< [m]
  static constexpr double kStandingErrorTheta = 0.015;  ///< [rad]
  // Faults: what odometry missed in all while it should have stood, from which on it is frozen.
  static constexpr double kFrozenError = 0.1;        ///< [m]
  static constexpr double kFrozenErrorTheta = 0.15;  ///< [rad]
  /// [m] Faults: a way that is not shorter may have been driven backwards by a base whose odometry does not tell;
  /// shorter ones are within the window anyway.
  static constexpr double kReversible = 0.1;
  static constexpr double kBackwards = 0.01;  ///< [m] by which odometry says that the base went backwards, beyond noise
  // Faults: a jump that a robot may have driven while odometry stood still, not for longer than it stays frozen, is
  // believed first.
  static constexpr double kMaxFreeze = 10.0;       ///< [s]
  static constexpr double kFrozenSpeed = 1.0;      ///< [m/s], how fast robots drive
  static constexpr double kFrozenTurnRate = 2.0;   ///< [rad/s]
  static constexpr std::size_t kMaxFaults = 1000;  ///< that are kept with their times; all are counted
};

}  // namespace oort
