// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Maps a square room from its middle with the C++ library, then renders, saves and loads the map.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <oort/oort.hpp>
#include <string>

namespace {

// What a sensor with 180 beams sees in a room of 4 m by 4 m.
oort::LaserScan look(const oort::Pose2& sensor, double time) {
  oort::LaserScan scan;
  scan.time = time;
  scan.angle_min = -M_PI / 2;
  scan.angle_increment = M_PI / 180;
  scan.range_min = 0.05;
  scan.range_max = 6.0;
  for (int i = 0; i < 180; ++i) {
    const double bearing = sensor.theta + scan.angle_min + i * scan.angle_increment;
    const double x_wall = std::cos(bearing) > 0 ? 2.0 - sensor.x : -2.0 - sensor.x;
    const double y_wall = std::sin(bearing) > 0 ? 2.0 - sensor.y : -2.0 - sensor.y;
    scan.ranges.push_back(static_cast<float>(std::min(x_wall / std::cos(bearing), y_wall / std::sin(bearing))));
  }
  return scan;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: embed MAP_BASE\n";
    return EXIT_FAILURE;
  }
  try {
    oort::Mapper mapper{oort::Parameters{}};
    for (int i = 0; i < 40; ++i) {
      const oort::Pose2 pose{0.02 * i, 0.0, 0.05 * i};
      mapper.add_scan(look(pose, 0.1 * i), pose);
    }
    mapper.create_location("places", "end", mapper.sensor_pose());
    mapper.finish();
    oort::save_map(argv[1], mapper.map());
    const oort::Map loaded = oort::load_map(argv[1]);
    const oort::OccupancyGrid grid = oort::render(loaded).map;
    std::cout << loaded.graph.nodes.size() << " nodes, " << grid.width << " x " << grid.height << " cells, "
              << loaded.locations.size() << " location\n";
  } catch (const oort::Error& error) {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
}
