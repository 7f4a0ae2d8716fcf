// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/localization/place_finder.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "oort/geometry/chi_square.hpp"
#include "oort/geometry/errors.hpp"
#include "oort/graph/relative_uncertainty.hpp"
#include "oort/localization/place_tuning.hpp"
#include "oort/map/trajectory_walk.hpp"
#include "oort/matching/frsm_adapter.hpp"

namespace oort {
namespace {

/// What a node and those before it saw, oldest first, each where the trajectory has it as seen from the node.
std::vector<PlacedScan> views_of(const Map& map, const TrajectorySegments& segments, std::uint64_t first,
                                 std::uint64_t node, double spacing = 0.0) {
  const std::uint64_t most = PlaceTuning::kNodesPerSearch;
  const std::uint64_t walked = spacing > 0.0 ? PlaceTuning::kNodesWalked : most;
  std::vector<PlacedScan> views;
  for (const PlacedNode& placed :
       walk_trajectory(map, segments, node, Direction::kBackward, std::min(walked, node - first + 1))) {
    const bool is_apart =
        views.empty() || between(views.back().T_odom_sensor, placed.T_origin_node).translation().norm() >= spacing;
    if (is_apart) views.push_back({map.clouds[placed.node], placed.T_origin_node});
    if (views.size() == most) break;
  }
  std::reverse(views.begin(), views.end());
  return views;
}

double apart(const Map& map, std::uint64_t a, std::uint64_t b) {
  return (map.graph.nodes[a].pose.translation() - map.graph.nodes[b].pose.translation()).norm();
}

/// Of following every beam of the views through a grid.
double work_of_weighing(const std::vector<PlacedScan>& views, double cell) {
  double steps = 0.0;
  for (const PlacedScan& view : views) {
    for (const frsm::Point& point : returns_of(view.cloud)) steps += std::hypot(point.x, point.y) / cell;
  }
  return PlaceTuning::kWorkPerRayStep * steps;
}

}  // namespace

bool PlaceFinder::use(const Map& map, const std::vector<std::uint64_t>& nodes, bool anew, WorkMeter* meter,
                      double spacing) {
  if (nodes.empty()) return false;
  const bool is_older = reference_ && given_.back() <= nodes.back();
  const bool is_like_new = is_older && map.graph.nodes.size() < drawn_at_ + given_.size() / PlaceTuning::kRedrawParts;
  if (is_older && ((is_like_new && !anew) || (given_ == nodes && !has_moved(map)))) return true;
  draw(map, nodes, spacing, meter);
  return reference_ != nullptr;
}

bool PlaceFinder::has_moved(const Map& map) const {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Pose2 moved = between(poses_[k], map.graph.nodes[nodes_[k]].pose);
    if (moved.translation().norm() > PlaceTuning::kReferenceMoved) return true;
  }
  return false;
}

void PlaceFinder::draw(const Map& map, const std::vector<std::uint64_t>& nodes, double spacing, WorkMeter* meter) {
  forget();
  given_ = nodes;
  for (const std::uint64_t node : nodes) {
    if (nodes_.empty() || apart(map, nodes_.back(), node) >= spacing) nodes_.push_back(node);
  }
  drawn_at_ = map.graph.nodes.size();
  std::uint64_t points = 0;
  for (const std::uint64_t node : nodes_) {
    poses_.push_back(map.graph.nodes[node].pose);
    points += map.clouds[node].points.size();
  }
  charge(meter, PlaceTuning::kWorkPerReferencePoint * static_cast<double>(points));
  try {
    reference_ = std::make_shared<const ReferenceMap>(map, nodes_, parameters_);
    relocalizer_ = std::make_unique<Relocalizer>(reference_, parameters_);
  } catch (const InputError&) {
    forget();
  }
}

void PlaceFinder::forget() {
  given_.clear();
  nodes_.clear();
  poses_.clear();
  reference_.reset();
  relocalizer_.reset();
}

Look PlaceFinder::find(const Map& map, const TrajectorySegments& segments, std::uint64_t first, std::uint64_t node,
                       WorkMeter* meter, const PlaceSearch& search) const {
  SearchEffort effort;
  effort.area = search.area;
  if (effort.area) effort.area->T_map_sensor = drawn(map, effort.area->T_map_sensor);
  effort.floor = PlaceTuning::kLeastScore;
  effort.turn_cells = PlaceTuning::kTurnCells;
  effort.ratio = PlaceTuning::kRivalScore;
  effort.max_points = PlaceTuning::kSearchPoints;
  effort.max_expansions = search.max_expansions;
  effort.max_expansions_to_first = search.max_expansions / PlaceTuning::kExpansionsToFirst;
  effort.max_peaks = PlaceTuning::kSearchPeaks;
  effort.min_support = search.least_support;
  effort.weighs_incomplete = false;
  frsm::OnLookups on_lookups;
  if (meter != nullptr) {
    on_lookups = [meter](std::uint64_t lookups) {
      charge(meter, PlaceTuning::kWorkPerLookup * static_cast<double>(lookups));
    };
  }
  const std::vector<PlacedScan> views = views_of(map, segments, first, node, search.view_spacing);
  charge(meter, PlaceTuning::kWeighedPlaces * work_of_weighing(views, reference_->space().limits().resolution));
  const Relocalization found = relocalizer_->find(views, effort, on_lookups);
  if (!found.found()) {
    return {std::nullopt, !found.stands_out || found.rejection == Rejection::kSearchLowSupport};
  }
  const Support& support = found.best->support;
  const bool is_weak = search.weighs && support.value() < parameters_.localization.relocalizer.min_support;
  if (is_weak && support.blocked + support.in_free > PlaceTuning::kWeakContradictions * support.points) return {};
  const Pose2& T_drawn_node = found.best->T_map_sensor;
  const std::size_t nearest = nearest_drawn(T_drawn_node);
  const Pose2 T_map_drawn = map.graph.nodes[nodes_[nearest]].pose * inverse(poses_[nearest]);
  return {FoundPlace{node, T_map_drawn * T_drawn_node, rotate_covariance(found.best->covariance, T_map_drawn.theta),
                     is_weak},
          false};
}

PlaceFinder::Fit PlaceFinder::fit(const Map& map, const TrajectorySegments& segments, std::uint64_t first,
                                  std::uint64_t node, WorkMeter* meter) const {
  const std::vector<PlacedScan> views = views_of(map, segments, first, node);
  charge(meter, work_of_weighing(views, reference_->space().limits().resolution));
  const Pose2 T_drawn_node = drawn(map, map.graph.nodes[node].pose);
  Support support;
  for (const PlacedScan& view : views) {
    reference_->weigh(view.cloud, T_drawn_node * view.T_odom_sensor, support);
  }
  return {support.blocked + support.in_free > PlaceTuning::kContradictingShare * support.points,
          support.value() > PlaceTuning::kWeakSupport};
}

bool PlaceFinder::may_have_drifted(const FoundPlace& answer, const Map& map) const {
  RelativeUncertainty uncertainty;
  uncertainty.update(map.graph);
  return may_have_drifted(answer, map, uncertainty.from(map.graph, answer.node)[nearest(answer, map)]);
}

bool PlaceFinder::may_have_drifted(const FoundPlace& answer, const Map& map,
                                   const std::optional<Eigen::Matrix3d>& known) const {
  if (!known) return true;
  const Pose2& T_map_node = map.graph.nodes[answer.node].pose;
  const Pose2& T_map_nearest = map.graph.nodes[nearest(answer, map)].pose;
  const Pose2 expected = between(T_map_node, T_map_nearest), found = between(answer.T_map_node, T_map_nearest);
  const Eigen::Vector2d moved = rotation(T_map_node.theta) * (found.translation() - expected.translation());
  const double turned = wrap_angle(found.theta - expected.theta);
  if (moved.norm() < PlaceTuning::kCarried && std::abs(turned) < PlaceTuning::kCarriedAngle) return true;
  const Eigen::Vector3d difference(moved.x(), moved.y(), turned);
  const Eigen::Vector3d floor(PlaceTuning::kSameAnswer, PlaceTuning::kSameAnswer, PlaceTuning::kSameAnswerAngle);
  const Eigen::Matrix3d wide = 4.0 * *known + Eigen::Matrix3d(floor.cwiseAbs2().asDiagonal());
  return difference.dot(wide.inverse() * difference) < ChiSquare3::k99999;
}

Closure PlaceFinder::closure(const FoundPlace& place, const Map& map) const {
  const std::uint64_t to = nearest(place, map);
  const Eigen::Vector3d sigma(PlaceTuning::kAnswerSigma, PlaceTuning::kAnswerSigma, PlaceTuning::kAnswerSigmaTheta);
  const Eigen::Matrix3d covariance = rotate_covariance(place.covariance, -place.T_map_node.theta);
  return {place.node, to, between(place.T_map_node, map.graph.nodes[to].pose),
          covariance + Eigen::Matrix3d(sigma.cwiseAbs2().asDiagonal()), 1.0};
}

/// A pose of the map on what was drawn.
Pose2 PlaceFinder::drawn(const Map& map, const Pose2& pose) const {
  const std::size_t nearest = nearest_to(map, pose);
  return poses_[nearest] * between(map.graph.nodes[nodes_[nearest]].pose, pose);
}

/// Of the drawn nodes, by their place among them: as they were drawn,
std::size_t PlaceFinder::nearest_drawn(const Pose2& T_drawn_node) const {
  const auto distance = [&](const Pose2& pose) { return (pose.translation() - T_drawn_node.translation()).norm(); };
  return static_cast<std::size_t>(
      std::min_element(poses_.begin(), poses_.end(),
                       [&](const Pose2& a, const Pose2& b) { return distance(a) < distance(b); }) -
      poses_.begin());
}

/// and as they are.
std::size_t PlaceFinder::nearest_to(const Map& map, const Pose2& T_map_node) const {
  const auto distance = [&](std::uint64_t node) {
    return (map.graph.nodes[node].pose.translation() - T_map_node.translation()).norm();
  };
  return static_cast<std::size_t>(
      std::min_element(nodes_.begin(), nodes_.end(),
                       [&](std::uint64_t a, std::uint64_t b) { return distance(a) < distance(b); }) -
      nodes_.begin());
}

bool agree(const FoundPlace& a, const FoundPlace& b, const Pose2& T_a_b) {
  const Pose2 apart = between(a.T_map_node * T_a_b, b.T_map_node);
  return apart.translation().norm() <= PlaceTuning::kSameAnswer &&
         std::abs(apart.theta) <= PlaceTuning::kSameAnswerAngle;
}

}  // namespace oort
