// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "oort/geometry/work_meter.hpp"
#include "oort/map/map.hpp"
#include "oort/map/trajectory_segments.hpp"
#include "oort/matching/rejection.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// Where a query is looked for in a candidate's submap: around the pose that the graph expects.
struct SearchWindow {
  double xy = 0.0;             ///< half width [m]
  double theta = 0.0;          ///< half width [rad]
  Eigen::Matrix3d covariance;  ///< of the expected T_candidate_query, along the axes of the candidate
};

/// How much is matched at once.
struct LoopScale {
  std::uint64_t query_nodes = 1;    ///< along the query's trajectory
  std::uint64_t submap_nodes = 15;  ///< along the candidate's trajectory
  std::size_t rough_points = 100;   ///< that the search over the whole window looks at, evenly chosen
  std::size_t fine_points = 0;      ///< that the search around its result looks at; 0: all
  double max_ambiguity = 1.0;       ///< largest score of the best pose elsewhere, as a share of the best; 1: any
  double sigma_xy = 0.0;            ///< how far the trajectory is bent over the nodes that are matched [m]
  double sigma_theta = 0.0;         ///< [rad]
  double reach = 1e3;               ///< returns farther from their sensor are left out [m]

  /// The covariance of how far the trajectory is bent, in x, y, theta.
  Eigen::Matrix3d bend() const { return Eigen::Vector3d(sigma_xy, sigma_xy, sigma_theta).cwiseAbs2().asDiagonal(); }
};

/// Measures where a node stands in the submap of another.
class LoopMatcher {
 public:
  struct Found {
    Pose2 T_candidate_query;     ///< the best there is, accepted or not
    Eigen::Matrix3d covariance;  ///< along the axes of the candidate
    double inlier_ratio = 0.0;
    Rejection rejection = Rejection::kNone;  ///< why it is not accepted
  };

  virtual ~LoopMatcher() = default;

  virtual Found find(const Map& map, const TrajectorySegments& segments, std::uint64_t query, std::uint64_t candidate,
                     const SearchWindow& window, WorkMeter* meter = nullptr) = 0;

  /// Draws the next scans of the candidate's submap, so that find() need not draw them all at once. False if there was
  /// nothing left to draw.
  virtual bool draw(const Map& map, const TrajectorySegments& segments, std::uint64_t candidate,
                    WorkMeter* meter = nullptr) = 0;
};

/// The matcher that loop_closure_graph_builder.scanmatcher names.
std::unique_ptr<LoopMatcher> make_loop_matcher(const Parameters& parameters, const LoopScale& scale);

}  // namespace oort
