// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace oort {

/// Constants of geometry that were chosen, not derived.
struct GeometryTuning {
  // A scan is deskewed if the base moved by less while it was taken: a home robot drives at 0.5 m/s and turns at
  // 3 rad/s, and a scan takes a fifth of a second at most. More is a jump of odometry.
  static constexpr double kMaxSweepTranslation = 1.0;  ///< [m]
  static constexpr double kMaxSweepRotation = 1.0;     ///< [rad]

  /// [m] Readings from here on are no return: no planar laser for indoors measures farther (the longest of the public
  /// logs says 81.9 m), and one such point would make a map too wide to be drawn.
  static constexpr double kMaxRange = 150.0;

  /// [rad] From beam to beam. Finer is no sensor's (the finest have 4e-4), nor is a scan of more than two turns.
  static constexpr double kMinAngleIncrement = 1e-7;
  static constexpr double kMaxFieldOfView = 12.6;

  /// Beams of a scan; the finest lasers have some 15,000.
  static constexpr double kMaxBeams = 1e6;

  /// [m] Neighbouring returns of a scan that are farther apart lie on different surfaces.
  static constexpr double kMaxSurfaceGap = 0.3;
};

}  // namespace oort
