// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "oort/map/map.hpp"

namespace oort {

/// A map without a graph: what was seen from poses that are taken as they are, such as of a picture of a place. Good to
/// find and follow a robot on. Throws InputError if the numbers of poses and clouds differ or a pose is not finite.
Map map_of_views(const std::vector<Pose2>& T_map_sensor, std::vector<PointCloud> clouds);

}  // namespace oort
