// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/localization/reference_map.hpp"

#include <Eigen/Geometry>
#include <frsm/contours.hpp>
#include <string>

#include "oort/geometry/errors.hpp"
#include "oort/localization/tuning.hpp"
#include "oort/loop_closure/normal_consistency.hpp"
#include "oort/map/map_check.hpp"
#include "oort/matching/frsm_adapter.hpp"
#include "oort/matching/frsm_setup.hpp"
#include "oort/parameters/table.hpp"

namespace oort {
namespace {

/// Cells `coarser` times as large as usual.
frsm::TableParams fine_params(const Parameters& parameters, double coarser) {
  frsm::TableParams params = table_params(parameters.incremental_graph_builder.frsm_matcher);
  params.cell *= coarser;
  return params;
}

frsm::TableParams coarse_params(const Parameters& parameters, double coarser) {
  frsm::TableParams params = table_params(parameters.incremental_graph_builder.frsm_matcher);
  params.cell = coarser * LocalizationTuning::kCoarseCell;
  params.sigma = coarser * LocalizationTuning::kCoarseSigma;
  return params;
}

double coarser(const KnownSpace& space) {
  return space.limits().resolution / LocalizationTuning::kCell;
}

std::vector<std::uint64_t> all_nodes(const Map& map) {
  std::vector<std::uint64_t> nodes;
  for (const Node& node : map.graph.nodes) nodes.push_back(node.id);
  return nodes;
}

const Map& checked(const Map& map, const Parameters& parameters) {
  check_parameters(parameters);
  if (map.graph.nodes.empty()) throw InputError("localisation: the map is empty; give one that was mapped and saved");
  const std::optional<std::string> defect = find_defect(map);
  if (defect) throw InputError("localisation: this map cannot be used: " + *defect);
  return map;
}

}  // namespace

double Support::value() const {
  if (points == 0) return 0.0;
  return (inliers - LocalizationTuning::kTurnedWeight * turned - LocalizationTuning::kBlockedWeight * blocked) / points;
}

ReferenceMap::ReferenceMap(const Map& map, const Parameters& parameters)
    : ReferenceMap(checked(map, parameters), all_nodes(map), parameters) {}

ReferenceMap::ReferenceMap(const Map& map, const std::vector<std::uint64_t>& nodes, const Parameters& parameters)
    : space_(map, nodes),
      fine_(fine_params(parameters, coarser(space_))),
      coarse_(coarse_params(parameters, coarser(space_))),
      hit_value_(matcher_params(parameters.incremental_graph_builder.frsm_matcher).hit_value) {
  reserve(map, nodes);
  for (const std::uint64_t node : nodes) {
    const frsm::Pose pose = to_frsm(map.graph.nodes[node].pose);
    const frsm::Points points = returns_of(map.clouds[node]);
    const frsm::Points world = frsm::transform(pose, points);
    const std::vector<frsm::Contour> contours = frsm::extract_contours(points, frsm::ContourParams::urg());
    fine_.draw(world, contours, pose);
    coarse_.draw(world, contours, pose);
  }
}

/// Drawing would else copy the tables again and again as they grow.
void ReferenceMap::reserve(const Map& map, const std::vector<std::uint64_t>& nodes) {
  Eigen::AlignedBox2d box;
  for (const std::uint64_t node : nodes) box.extend(map.graph.nodes[node].pose.translation());
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(fine_.params().radius);
  const GridLimits& limits = space_.limits();
  const Eigen::Vector2d low(limits.origin_x, limits.origin_y);
  const Eigen::Vector2d high = low + limits.resolution * Eigen::Vector2d(limits.width, limits.height);
  const Eigen::Vector2d from = (box.min() - reach).cwiseMax(low), to = (box.max() + reach).cwiseMin(high);
  for (frsm::Table* table : {&fine_, &coarse_}) table->reserve({from.x(), from.y()}, {to.x(), to.y()});
}

void ReferenceMap::weigh(const PointCloud& cloud, const Pose2& T_map_sensor, Support& support) const {
  const frsm::Points points = frsm::within(returns_of(cloud), fine_.params().radius);
  const auto is_inlier = [&](const Eigen::Vector2d& p) {
    return fine_.value(fine_.index(p.x()), fine_.index(p.y())) >= hit_value_;
  };
  for (const frsm::Point& point : points) {
    const Eigen::Vector2d p = T_map_sensor * Eigen::Vector2d(point.x, point.y);
    ++support.points;
    if (space_.is_blocked(T_map_sensor.translation(), p, LocalizationTuning::kBlockedMargin)) {
      ++support.blocked;
    } else if (is_inlier(p)) {
      ++support.inliers;
    } else if (space_.is_free(p)) {
      ++support.in_free;
    }
  }
  const Eigen::Matrix2d R = rotation(T_map_sensor.theta);
  for (const SurfacePoint& surface : surface_points(points)) {
    const Eigen::Vector2d p = T_map_sensor * surface.position;
    if (!is_inlier(p)) continue;
    const KnownSpace::Facing facing = space_.facing(p, R * surface.normal);
    if (facing != KnownSpace::Facing::kUnknown) ++support.surfaces;
    if (facing == KnownSpace::Facing::kOther) ++support.turned;
  }
}

}  // namespace oort
