// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// 01: maps a CARMEN log, saves the map and renders it.
#include <cstdio>
#include <oort/oort.hpp>
#include <string>

#include "carmen_log.hpp"
#include "example_main.hpp"

namespace {

void map_a_log(const std::string& log_path, const std::string& map_path) {
  const CarmenLog log = read_carmen_log(log_path);
  oort::Parameters parameters;  // the defaults; oort::read_parameters(path) reads a file
  parameters.linear_update = 0.3;
  oort::Mapper mapper(parameters, log.T_base_sensor);

  std::size_t uncertain = 0;
  for (const LoggedScan& logged : log.scans) {
    const oort::ScanResult result = mapper.add_scan(logged.scan, logged.T_odom_base);
    uncertain += result.tracking != oort::TrackingState::kTracking;
  }
  mapper.finish();
  oort::save_map(map_path, mapper.map());

  const oort::OccupancyGrid grid = oort::render(mapper.map(), parameters).map_cleaned;
  std::printf("%zu scans, %zu of them uncertain\n", log.scans.size(), uncertain);
  std::printf("%zu nodes, %d x %d cells\n", mapper.map().graph.nodes.size(), grid.width, grid.height);
}

}  // namespace

int main(int argc, char** argv) {
  return example_main(argc, argv, map_a_log);
}
