// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "oort/parameters/parameters.hpp"
#include "oort/render/occupancy_grid.hpp"

namespace oort {

/// The map without speckle noise: small unknown spots within free space become free, stray occupied cells go.
///
/// Median: median.iter passes of a median filter over free and unknown cells. A plain median would eat walls, which
/// short-range sensors draw one cell thick. So occupied cells take no part in it: connected ones
/// (8-connected) in groups of at least median.kernel_size cells stay, others become what is around them, and no cell
/// becomes occupied.
///
/// Morphological: the free and the occupied cells are closed (dilated, then eroded, by a 3x3 square, as many times as
/// their number of iterations) each on a layer of its own; then free is painted first, occupied over it, and a cell on
/// neither layer is unknown. Closing fills gaps of up to two cells per iteration and never takes a wall away.
///
/// Throws ParameterError if the strategy is unknown, the kernel size not odd or a number of iterations negative.
OccupancyGrid remove_speckles(const OccupancyGrid& map, const OutputMapParameters& parameters);

}  // namespace oort
