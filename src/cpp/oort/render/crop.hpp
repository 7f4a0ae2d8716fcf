// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "oort/graph/graph.hpp"
#include "oort/map/map.hpp"
#include "oort/map/point_clouds.hpp"

namespace oort {

/// What can be drawn of a map.
struct Cropped {
  std::vector<Node> nodes;
  PointClouds clouds;  ///< one for each node
};

/// Some nodes of a map, by their numbers. Throws InputError for one that the map does not have.
Cropped choose(const Map& map, const std::vector<std::uint64_t>& nodes);

/// The nodes in a box of the map frame [m], each with those of its beams that do not end outside the box: for maps that
/// a few far readings or absurd poses make too wide to be drawn. Arguments as of render().
/// Throws InputError if the counts differ or the box is empty.
Cropped crop(const std::vector<Node>& nodes, const PointClouds& clouds, const Eigen::AlignedBox2d& box);

}  // namespace oort
