// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace oort {

/// Constants of grids and filters that were chosen, not derived.
struct GridTuning {
  // Of the adaptive voxel filter.
  static constexpr double kMinVoxelShare = 0.01;  ///< of max_length; smaller voxels thin nothing that a sensor resolves
  static constexpr double kVoxelPrecision = 0.1;  ///< at which the search for the side ends, as a share of it
};

}  // namespace oort
