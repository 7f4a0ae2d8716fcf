// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "oort/graph/optimizer.hpp"

namespace oort {

/// A landmark with an id (a tag), seen between two nodes.
struct LandmarkObservation {
  std::uint64_t landmark = 0;  ///< which one it is: any number, the same for the same thing
  std::uint64_t before = 0;    ///< the sensor was between these two nodes,
  std::uint64_t after = 0;
  double fraction = 0.0;  ///< this far from the first to the second, in [0, 1]
  Pose2 T_sensor_landmark;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< x, y, theta along the axes of the sensor
};

/// Poses in the map, by landmark.
using Landmarks = std::map<std::uint64_t, Pose2>;

/// optimize() with what was seen of landmarks, which get their poses in `landmarks`; always with RobustKernel::kHuber,
/// on observations too, as one may be of something else. The sensor's pose at an observation is interpolated between
/// the nodes', a fraction of the translation and of the shorter turn. `landmarks` holds where to start from; one that
/// is not there starts where it was first seen. InputError, with everything unchanged, also if an observation cannot be
/// used; the message says which.
OptimizerSummary optimize_with_landmarks(Graph& graph, const std::vector<LandmarkObservation>& observations,
                                         Landmarks& landmarks, const OptimizerOptions& options);

}  // namespace oort
