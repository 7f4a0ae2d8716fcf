// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "oort/graph/graph.hpp"
#include "oort/map/map.hpp"
#include "oort/map/point_clouds.hpp"
#include "oort/parameters/parameters.hpp"
#include "oort/render/occupancy_grid.hpp"

namespace oort {

struct RenderedMap {
  OccupancyGrid map;  ///< as the clouds say, with the robot's trajectory cleared
  OccupancyGrid
      map_cleaned;  ///< the same without speckle noise, for path planning; the robot's trajectory is free here too
};

/// Draws the map that the clouds show from their nodes' poses.
///
/// Each cloud goes once into a probability grid, in the order of the nodes; the thresholds turn it into free, occupied
/// and unknown cells; a disc of robot_radius around each node, or around
/// footprint_x and _y seen from it, is set free. The grid's upper right corner is that of the
/// box around all hits, which is widened where a node or a cleared stretch lies outside it.
///
/// `clouds[k]` was taken at `nodes[k]`, in the sensor's frame. No nodes give empty grids (width and height 0).
/// Throws ParameterError for parameters that make no sense, InputError (naming the node) if the counts differ, a pose
/// is not finite or a node or its cloud lies too far off for a grid.
RenderedMap render(const std::vector<Node>& nodes, const PointClouds& clouds, const OutputMapParameters& parameters);

/// The same of some nodes of a map; of the parameters output_map counts.
RenderedMap render(const Map& map, const std::vector<std::uint64_t>& nodes, const Parameters& parameters);

/// The same of the map's main part: where loose ones lie is not known (map/parts.hpp), and drawn over it they would
/// make walls where there are none.
RenderedMap render(const Map& map, const Parameters& parameters = {});

}  // namespace oort
