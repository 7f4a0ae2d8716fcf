// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "oort/geometry/points.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// Thins points so that they lie less densely near the sensor: of those in one square of side `length` [m], the first
/// stays. Order is kept. Throws ParameterError for a length that is not positive.
Points voxel_filter(const Points& points, double length);

/// Drops points farther than max_range from the origin, then thins what is left with the largest squares, up to
/// max_length, that leave at least min_num_points, or all if there are no more. The largest length is found to a tenth
/// by halving and bisection; as counts need not fall with the length, a larger one may exist.
Points adaptive_voxel_filter(const Points& points, const AdaptiveVoxelFilterParameters& parameters);

}  // namespace oort
