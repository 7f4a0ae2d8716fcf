// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// 04: names places while mapping, takes the dock as an anchor, and shows that places move with the map.
#include <cstdio>
#include <oort/oort.hpp>
#include <string>

#include "carmen_log.hpp"
#include "example_main.hpp"

namespace {

void print_place(const char* when, const oort::Pose2& pose) {
  std::printf("%s the place is at %.3f %.3f\n", when, pose.x, pose.y);
}

void places_and_dock(const std::string& log_path, const std::string& map_path) {
  const CarmenLog log = read_carmen_log(log_path);
  oort::Mapper mapper(oort::Parameters{}, log.T_base_sensor);
  for (std::size_t k = 0; k < log.scans.size(); ++k) {
    mapper.add_scan(log.scans[k].scan, log.scans[k].T_odom_base);
    if (k == 0) mapper.create_location("dock", "dock", mapper.sensor_pose());  // the drive begins at the dock
    if (k == log.scans.size() / 2) mapper.create_location("places", "middle", mapper.sensor_pose());
  }
  print_place("while driving", mapper.locate("places", "middle").value());

  const bool fits = mapper.notify_docked();  // and ends there
  mapper.finish();
  std::printf("what is seen at the dock %s the map\n", fits ? "fits" : "does not fit");
  print_place("at the end", mapper.locate("places", "middle").value());

  oort::save_map(map_path, mapper.map());
  const oort::Map map = oort::load_map(map_path);
  print_place("in the saved map", oort::locate(map, "places", "middle").value());
}

}  // namespace

int main(int argc, char** argv) {
  return example_main(argc, argv, places_and_dock);
}
