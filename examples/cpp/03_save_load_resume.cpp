// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// 03: maps half of a log, saves the map, loads it and goes on with the other half in a new session.
#include <cstdio>
#include <oort/oort.hpp>
#include <string>

#include "carmen_log.hpp"
#include "example_main.hpp"

namespace {

void save_load_resume(const std::string& log_path, const std::string& map_path) {
  const CarmenLog log = read_carmen_log(log_path);
  const std::size_t half = log.scans.size() / 2;
  const oort::Parameters parameters;

  oort::Mapper first(parameters, log.T_base_sensor);
  for (std::size_t k = 0; k < half; ++k) first.add_scan(log.scans[k].scan, log.scans[k].T_odom_base);
  first.finish();
  const oort::Pose2 last_pose = first.sensor_pose();
  oort::save_map(map_path, first.map());
  std::printf("first session: %zu nodes\n", first.map().graph.nodes.size());

  oort::Mapper second(parameters, log.T_base_sensor);
  second.set_map(oort::load_map(map_path));
  second.begin_session(last_pose);  // about where the sensor is on the map
  for (std::size_t k = half; k < log.scans.size(); ++k) second.add_scan(log.scans[k].scan, log.scans[k].T_odom_base);
  second.finish();
  oort::save_map(map_path, second.map());
  std::printf("both sessions: %zu nodes, %zu closures\n", second.map().graph.nodes.size(),
              second.map().graph.switchable_edges.size());
}

}  // namespace

int main(int argc, char** argv) {
  return example_main(argc, argv, save_load_resume);
}
