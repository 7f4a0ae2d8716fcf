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

  /// [m] Neighbouring returns of a scan that are farther apart lie on different surfaces.
  static constexpr double kMaxSurfaceGap = 0.3;
};

}  // namespace oort
