// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace oort {

/// Quantiles of the chi-square distribution with three degrees of freedom: what the squared Mahalanobis distance of two
/// planar poses stays below by chance.
struct ChiSquare3 {
  static constexpr double k95 = 7.815;      ///< 95 %
  static constexpr double k99 = 11.345;     ///< 99 %
  static constexpr double k999 = 16.266;    ///< 99.9 %
  static constexpr double k99999 = 25.902;  ///< 99.999 %
};

}  // namespace oort
