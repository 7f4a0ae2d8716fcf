// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/map/map_of_views.hpp"

#include <string>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/map/map_check.hpp"

namespace oort {

Map map_of_views(const std::vector<Pose2>& T_map_sensor, std::vector<PointCloud> clouds) {
  if (T_map_sensor.size() != clouds.size()) {
    throw InputError("map of views: " + std::to_string(T_map_sensor.size()) + " poses but " +
                     std::to_string(clouds.size()) + " clouds");
  }
  Map map;
  for (std::size_t k = 0; k < clouds.size(); ++k) {
    Node node;
    node.id = k;
    node.pose = T_map_sensor[k];
    map.graph.nodes.push_back(node);
    clouds[k].id = k;
    map.clouds.push_back(std::move(clouds[k]));
    IncrementalResult result;
    result.id = result.target = k;
    result.T_local_id = node.pose;
    map.incremental_results.push_back(result);
  }
  if (const std::optional<std::string> defect = find_defect(map)) throw InputError("map of views: " + *defect);
  return map;
}

}  // namespace oort
