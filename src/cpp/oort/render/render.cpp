// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/render/render.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "oort/geometry/errors.hpp"
#include "oort/grid/range_data.hpp"
#include "oort/map/parts.hpp"
#include "oort/render/crop.hpp"
#include "oort/render/speckle.hpp"

namespace oort {
namespace {

void check_input(const std::vector<Node>& nodes, const PointClouds& clouds) {
  if (nodes.size() != clouds.size()) {
    throw InputError("render: " + std::to_string(nodes.size()) + " nodes but " + std::to_string(clouds.size()) +
                     " clouds; each node needs its own");
  }
  for (const Node& node : nodes) {
    if (!is_finite(node.pose)) {
      throw InputError("render: the pose of node " + std::to_string(node.id) +
                       " is not finite; the optimiser's result or the map file is damaged");
    }
  }
}

/// The centre of the disc that is free around a node.
Eigen::Vector2d footprint_of(const Node& node, const OutputMapParameters& parameters) {
  if (parameters.footprint_x == 0.0 && parameters.footprint_y == 0.0) return node.pose.translation();
  return (node.pose * Pose2{parameters.footprint_x, parameters.footprint_y, 0.0}).translation();
}

/// What one node and its cloud need of the grid.
Eigen::AlignedBox2d box_of(const Node& node, const PointCloud& cloud, const OutputMapParameters& parameters) {
  const Eigen::Vector2d centre = footprint_of(node, parameters);
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(parameters.robot_radius);
  Eigen::AlignedBox2d box(centre - reach, centre + reach);
  for (const BeamEnd& end : beam_ends(cloud, node.pose, parameters.probability_grid)) box.extend(end.point);
  return box;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The error for a map too wide for a grid: names the node whose box reaches farthest from where most nodes are.
InputError too_wide(const std::vector<Node>& nodes, const std::vector<Eigen::AlignedBox2d>& boxes) {
  std::vector<double> x, y;
  for (const Node& node : nodes) {
    x.push_back(node.pose.x);
    y.push_back(node.pose.y);
  }
  const Eigen::Vector2d centre(median(x), median(y));
  const auto reach = [&](const Eigen::AlignedBox2d& box) {
    return std::max((box.min() - centre).cwiseAbs().maxCoeff(), (box.max() - centre).cwiseAbs().maxCoeff());
  };
  const auto farthest =
      std::max_element(boxes.begin(), boxes.end(), [&](const auto& a, const auto& b) { return reach(a) < reach(b); });
  return InputError("render: node " + std::to_string(nodes[static_cast<std::size_t>(farthest - boxes.begin())].id) +
                    " or its cloud reaches " + std::to_string(reach(*farthest)) +
                    " m from the middle of the map, more than a grid can hold; correct its pose, leave it out, or "
                    "choose a coarser resolution");
}

GridLimits limits_of(const std::vector<Node>& nodes, const PointClouds& clouds, const OutputMapParameters& parameters) {
  std::vector<Eigen::AlignedBox2d> boxes;
  boxes.reserve(nodes.size());
  Eigen::AlignedBox2d all;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    boxes.push_back(box_of(nodes[k], clouds[k], parameters));
    all.extend(boxes.back());
  }
  if (!GridLimits::fits(all, parameters.probability_grid.resolution)) throw too_wide(nodes, boxes);
  return GridLimits::enclosing(all, parameters.probability_grid.resolution);
}

/// Free, occupied or unknown by the occupancy in whole percent.
OccupancyGrid threshold(const ProbabilityGrid& grid, const OutputMapParameters& parameters) {
  std::vector<std::int8_t> state_of(ProbabilityGrid::kMaxValue + 1, OccupancyGrid::kUnknown);
  for (std::uint16_t value = 1; value <= ProbabilityGrid::kMaxValue; ++value) {
    const long percent = std::lround(100.0 * ProbabilityGrid::value_to_probability(value));
    if (percent <= parameters.threshold.max_free) state_of[value] = OccupancyGrid::kFree;
    if (percent >= parameters.threshold.min_occupied) state_of[value] = OccupancyGrid::kOccupied;
  }
  const GridLimits& limits = grid.limits();
  OccupancyGrid map{limits.resolution, limits.origin_x, limits.origin_y, limits.width, limits.height, {}};
  map.cells.reserve(limits.cell_count());
  for (const std::uint16_t value : grid.values()) map.cells.push_back(state_of[value]);
  return map;
}

/// Sets the cells around each node free. The disc's cell is found by rounding, as the original does, not by flooring.
void clear_footprints(const std::vector<Node>& nodes, const OutputMapParameters& parameters, const GridLimits& limits,
                      OccupancyGrid& map) {
  const double radius = parameters.robot_radius / limits.resolution;
  const double limit = radius * radius * (1.0 + 1e-9);  // 0.15 / 0.05 is a little below 3
  const int reach = static_cast<int>(std::ceil(radius));
  for (const Node& node : nodes) {
    const Eigen::Vector2d centre = limits.to_cells(footprint_of(node, parameters)).array().round();
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const int column = static_cast<int>(centre.x()) + dx;
        const int row = static_cast<int>(centre.y()) + dy;
        if (dx * dx + dy * dy <= limit && limits.contains(column, row)) {
          map.cells[limits.index(column, row)] = OccupancyGrid::kFree;
        }
      }
    }
  }
}

}  // namespace

RenderedMap render(const std::vector<Node>& nodes, const PointClouds& clouds, const OutputMapParameters& parameters) {
  check_input(nodes, clouds);
  if (!std::isfinite(parameters.footprint_x) || !std::isfinite(parameters.footprint_y)) {
    throw ParameterError("output_map: footprint_x and footprint_y must be finite");
  }
  if (!(parameters.robot_radius >= 0.0) || !std::isfinite(parameters.robot_radius)) {
    throw ParameterError("output_map: robot_radius must be a distance in metres, not " +
                         std::to_string(parameters.robot_radius));
  }
  if (nodes.empty()) {
    const OccupancyGrid empty{parameters.probability_grid.resolution, 0.0, 0.0, 0, 0, {}};
    return {empty, empty};
  }
  const RangeDataInserter inserter(parameters.probability_grid);
  ProbabilityGrid grid(limits_of(nodes, clouds, parameters));
  for (std::size_t k = 0; k < nodes.size(); ++k) inserter.insert(clouds[k], nodes[k].pose, grid);
  OccupancyGrid map = threshold(grid, parameters);
  clear_footprints(nodes, parameters, grid.limits(), map);
  OccupancyGrid map_cleaned = remove_speckles(map, parameters);
  clear_footprints(nodes, parameters, grid.limits(), map_cleaned);  // filtering must not close the way again
  if (parameters.clean_map) map = map_cleaned;
  return {std::move(map), std::move(map_cleaned)};
}

RenderedMap render(const Map& map, const std::vector<std::uint64_t>& nodes, const Parameters& parameters) {
  const Cropped chosen = choose(map, nodes);
  return render(chosen.nodes, chosen.clouds, parameters.output_map);
}

RenderedMap render(const Map& map, const Parameters& parameters) {
  const MapParts parts = parts_of(map);
  if (parts.loose.empty()) return render(map.graph.nodes, map.clouds, parameters.output_map);
  return render(map, parts.main, parameters);
}

}  // namespace oort
