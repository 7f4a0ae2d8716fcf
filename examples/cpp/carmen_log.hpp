// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Reads the laser scans of a CARMEN log, with odometry: what the examples have in place of a robot.
#pragma once
#include <cmath>
#include <fstream>
#include <limits>
#include <oort/oort.hpp>
#include <sstream>
#include <string>
#include <vector>

struct LoggedScan {
  oort::LaserScan scan;
  oort::Pose2 T_odom_base;
};

struct CarmenLog {
  std::vector<LoggedScan> scans;
  oort::Pose2 T_base_sensor;  // of the first scan
};

namespace carmen {

inline oort::Pose2 read_pose(std::istream& in) {
  oort::Pose2 pose;
  in >> pose.x >> pose.y >> pose.theta;
  return pose;
}

inline std::vector<float> read_ranges(std::istream& in) {
  std::size_t count = 0;
  in >> count;
  std::vector<float> ranges;
  double range = 0.0;
  for (std::size_t k = 0; k < count && in >> range; ++k) ranges.push_back(static_cast<float>(range));
  return ranges;
}

// FLASER n r1..rn laser_x y theta robot_x y theta time: it tells no angles, the usual ones are -90 to 90 degrees.
inline oort::LaserScan read_flaser(std::istream& in) {
  oort::LaserScan scan;
  scan.range_max = 80.0;
  scan.ranges = read_ranges(in);
  const std::size_t n = scan.ranges.size();
  const double degrees = n == 181 ? 1.0 : n == 361 ? 0.5 : 180.0 / static_cast<double>(n);
  scan.angle_min = -M_PI / 2;
  scan.angle_increment = degrees * (M_PI / 180.0);
  return scan;
}

// ROBOTLASER1 type start view increment max_range accuracy mode n r1..rn m s1..sm laser_x y theta robot_x y theta ...
inline oort::LaserScan read_robotlaser(std::istream& in) {
  oort::LaserScan scan;
  double ignored = 0.0;
  in >> ignored >> scan.angle_min >> ignored >> scan.angle_increment >> scan.range_max >> ignored >> ignored;
  scan.ranges = read_ranges(in);
  read_ranges(in);  // the remissions
  return scan;
}

}  // namespace carmen

inline CarmenLog read_carmen_log(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw oort::InputError(path + " cannot be read");
  CarmenLog log;
  std::string line, keyword;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream in(line);
    in >> keyword;
    const bool is_robotlaser = keyword == "ROBOTLASER1";
    if (!is_robotlaser && keyword != "FLASER") continue;
    LoggedScan logged;
    logged.scan = is_robotlaser ? carmen::read_robotlaser(in) : carmen::read_flaser(in);
    const oort::Pose2 T_odom_sensor = carmen::read_pose(in);
    logged.T_odom_base = carmen::read_pose(in);
    double ignored = 0.0;
    for (int k = 0; is_robotlaser && k < 5; ++k) in >> ignored;  // speeds and safety distances
    in >> logged.scan.time;
    if (!in) throw oort::InputError(path + ": line " + std::to_string(number) + " is cut short");
    if (log.scans.empty()) log.T_base_sensor = oort::between(logged.T_odom_base, T_odom_sensor);
    log.scans.push_back(std::move(logged));
  }
  if (log.scans.empty()) throw oort::InputError(path + ": no laser scans");
  return log;
}
