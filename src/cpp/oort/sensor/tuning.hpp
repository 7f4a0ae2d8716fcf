// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace oort {

/// Constants of what is learned of a sensor that were chosen, not derived (docs/sensor.md).
struct SensorTuning {
  // Aligning two scans: point to line.
  static constexpr std::size_t kMaxAlignedPoints = 180;  ///< of the scan that is moved
  static constexpr std::size_t kMinAlignedPoints = 20;
  static constexpr std::size_t kPointsOfPairs = 60;  ///< of the scan that is moved, where a drive is diagnosed
  static constexpr int kAlignmentSteps = 15;
  static constexpr double kFirstReach = 0.5;  ///< [m] in which partners are looked for at first,
  static constexpr double kLastReach = 0.1;   ///< [m] and at last, where it is the greatest error that counts
  // Neighbouring returns beyond GeometryTuning::kMaxSurfaceGap lie on one surface if their beams are not farther apart
  // than a coarse laser's and the line through them is met at up to 60 degrees of incidence. Chosen on two made-up
  // drives (a warehouse, a forest; beams of 1 degree, 20 m), checked on halls, homes and recordings (docs/troubles.md).
  static constexpr double kMaxBeamStep = 0.035;  ///< [rad]
  static constexpr double kMaxBeamSlope = 1.7;   ///< of ranges to the distance across the beams
  static constexpr double kConverged = 1e-5;     ///< [m, rad]
  /// Least eigenvalue of the alignment's information per partner: below, a direction is left open (a corridor).
  static constexpr double kMinEigenvalue = 0.02;

  // The order of beams. A scan tells something of it if the base turned by so much more while it was taken than while
  // the reference was: 0.03 rad move a wall 3 m off by 9 cm, many times a laser's noise.
  static constexpr double kTellingTurn = 0.03;       ///< [rad]
  static constexpr double kReferenceDistance = 0.7;  ///< [m] from where the reference was taken,
  static constexpr double kReferenceAngle = 1.2;     ///< [rad]
  static constexpr int kReferenceAge = 30;           ///< and scans ago, at most
  static constexpr double kMinOverlap = 0.6;         ///< inlier ratio of the best order
  static constexpr std::size_t kMinOrderTests = 8;   ///< until it is decided
  /// A laser that spins does not measure all beams at once: that takes more to believe. The Kuri bags, whose laser
  /// spins, are otherwise taken so for eight scans that fit a little better.
  static constexpr std::size_t kMinAtOnceTests = 24;
  static constexpr std::size_t kMaxOrderTests = 400;  ///< until the order is left as stamped
  static constexpr double kClearCost = 0.8;           ///< of the best order to any other's
  static constexpr double kClearWins = 0.75;          ///< share of the tests in which it was the better of two

  /// [s] between a scan of the main laser and one of another that joins it; lasers have 5 to 40 Hz.
  static constexpr double kJoinedAge = 0.25;

  // Readings of the scan before, once more.
  static constexpr std::size_t kRepeatedReturns = 20;    ///< at least
  static constexpr std::uint64_t kChangedReadings = 10;  ///< scans that were others than the one before, until then
  static constexpr double kRepeatedMotion = 0.005;       ///< [m, rad] by odometry since they came first: it creeps less

  // The robot's own body.
  static constexpr int kBodyBins = 720;            ///< of half a degree
  static constexpr double kMaxBodyRange = 1.0;     ///< [m]; a chassis around a laser is nearer
  static constexpr double kBodyNoise = 0.02;       ///< [m] that readings of it differ by
  static constexpr double kBodyNoiseShare = 0.02;  ///< of the range, beside that
  static constexpr double kBodyTravel = 2.0;       ///< [m] over which a bearing shows the same range,
  static constexpr double kBodyTurn = 3.0;         ///< [rad]
  static constexpr std::size_t kBodyScans = 20;    ///< and how often
  // Fewer neighbours that agree than so many degrees of them need so many times the way and the turn: walls pass this
  // for a beam or two by chance.
  static constexpr double kBodyWidth = 0.05;    ///< [rad]
  static constexpr double kLoneBodyFactor = 3;  ///< of travel and turn
  // Suspected from the start, while nothing else was ever seen there; the range is that of a chassis.
  static constexpr double kSuspectRange = 0.5;   ///< [m]
  static constexpr double kSuspectTravel = 0.1;  ///< [m], or
  static constexpr double kSuspectTurn = 0.1;    ///< [rad]
  static constexpr double kBodyMisses = 0.1;     ///< share of scans that may show something else there
  static constexpr double kBodyMargin = 0.05;    ///< [m] beyond it that count as its edge
};

}  // namespace oort
