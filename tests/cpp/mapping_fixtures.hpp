// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/mapping/chains.hpp"
#include "oort/mapping/map.hpp"
#include "oort/mapping/mapper.hpp"
#include "oort/parameters/table.hpp"

/// What the tests of mapping share: a made-up room, a sensor that sees it, and drives through it.
namespace oort::testing {

inline constexpr double kPi = 3.14159265358979323846;

struct Wall {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
};
using World = std::vector<Wall>;

inline void add_outline(const std::vector<Eigen::Vector2d>& corners, World& world) {
  for (std::size_t k = 0; k < corners.size(); ++k) world.push_back({corners[k], corners[(k + 1) % corners.size()]});
}

/// 6 m by 4.5 m about the origin, with a niche, a sofa across a corner and a cupboard in the middle: no two places look
/// alike.
inline World make_room() {
  World world;
  add_outline({{-3.0, -2.0},
               {1.8, -2.0},
               {3.0, -1.1},
               {3.0, 2.5},
               {0.5, 2.5},
               {0.5, 3.0},
               {-0.6, 3.0},
               {-0.6, 2.5},
               {-3.0, 2.5}},
              world);
  add_outline({{-0.7, -0.3}, {0.6, -0.3}, {0.6, 0.7}, {-0.3, 0.8}}, world);
  return world;
}

struct Sensor {
  int beams = 180;
  double field_of_view = kPi;  ///< [rad], about straight ahead
  double range_max = 5.0;      ///< [m]
};
inline const Sensor kAllRound{360, 2.0 * kPi, 9.0};

inline double range_to(const World& world, const Eigen::Vector2d& p, double bearing) {
  const Eigen::Vector2d u(std::cos(bearing), std::sin(bearing));
  double range = std::numeric_limits<double>::infinity();
  for (const Wall& wall : world) {  // p + r u = a + s (b - a)
    const Eigen::Vector2d along = wall.b - wall.a;
    const double det = along.x() * u.y() - along.y() * u.x();
    if (std::abs(det) < 1e-12) continue;
    const Eigen::Vector2d d = wall.a - p;
    const double r = (along.x() * d.y() - along.y() * d.x()) / det;
    const double s = (u.x() * d.y() - u.y() * d.x()) / det;
    if (r > 0.0 && s >= 0.0 && s <= 1.0) range = std::min(range, r);
  }
  return range;
}

/// What a sensor sees from a place of the world.
inline LaserScan see(const World& world, const Pose2& T_world_sensor, double time, const Sensor& sensor = {}) {
  const double increment = sensor.field_of_view / sensor.beams;
  LaserScan scan{time, -0.5 * sensor.field_of_view, increment, 0.05, sensor.range_max, {}};
  for (int k = 0; k < sensor.beams; ++k) {
    const double bearing = T_world_sensor.theta + scan.angle_min + k * increment;
    scan.ranges.push_back(static_cast<float>(range_to(world, T_world_sensor.translation(), bearing)));
  }
  return scan;
}

/// True poses of a base that drives laps, counter-clockwise, around the cupboard, 4 cm a scan.
inline std::vector<Pose2> laps(double count) {
  constexpr double kStep = 0.04, kRadius = 0.6, kLength = 2.6, kWidth = 1.6;  // straight sides and quarter circles
  const double quarter = 0.5 * kPi * kRadius;
  const double lap = 2.0 * (kLength + kWidth) + 4.0 * quarter;
  std::vector<Pose2> poses;
  Pose2 pose{-1.3, -1.05, 0.0};
  double at = 0.0;  // on the lap
  for (int k = 0; k * kStep < count * lap; ++k) {
    poses.push_back(pose);
    double corner = at;  // where on its side and corner
    for (const double side : {kLength, kWidth, kLength, kWidth}) {
      if (corner < side + quarter) {
        const double turn = corner < side ? 0.0 : kStep / kRadius;
        pose = pose * Pose2{kStep, 0.0, turn};
        break;
      }
      corner -= side + quarter;
    }
    at = std::fmod(at + kStep, lap);
  }
  return poses;
}

/// Odometry of a drive: each step longer by `stretch`, and turned by `drift` [rad/m], with noise in proportion.
inline std::vector<Pose2> odometry_of(const std::vector<Pose2>& truth, double stretch, double drift,
                                      std::uint64_t seed = 1) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<Pose2> odometry{{0.7, -0.4, 2.0}};
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const Pose2 step = between(truth[k - 1], truth[k]);
    const double way = step.translation().norm();
    const double noise = drift * way * normal(generator);
    odometry.push_back(odometry.back() * Pose2{(1.0 + stretch) * step.x, step.y, step.theta + drift * way + noise});
  }
  return odometry;
}

inline const Pose2 kMount{0.109, 0.0, 0.0};  // T_base_sensor

/// Feeds a drive to a mapper, times counting up from `start` by 0.1 s.
inline void drive(Mapper& mapper, const World& world, const std::vector<Pose2>& truth,
                  const std::vector<Pose2>& odometry, double start = 100.0) {
  for (std::size_t k = 0; k < truth.size(); ++k) {
    mapper.add_scan(see(world, truth[k] * kMount, start + 0.1 * static_cast<double>(k)), odometry[k]);
  }
}

/// The parameters as documented.
inline Parameters documented_parameters() {
  Parameters parameters;
  for (const ParameterEntry& entry : parameter_table()) set_parameter(parameters, entry.path, entry.documented_value);
  return parameters;
}

/// A chain of nodes at true places of a world, with what is seen there: the graph's poses and the matcher's are true.
/// Nodes are appended to what is there, as a new segment.
inline void append_chain(const World& world, const std::vector<Pose2>& places, const Sensor& sensor, Map& map,
                         Chains& chains) {
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::uint64_t id = map.graph.nodes.size();
    PointCloud cloud = to_point_cloud(see(world, places[k], static_cast<double>(id), sensor));
    cloud.id = id;
    map.graph.nodes.push_back({id, places[k]});
    map.clouds.push_back(std::move(cloud));
    chains.add(k == 0, true, places[k]);
  }
}

/// The folder with the real data; empty where there is none.
inline std::string datasets() {
  const char* const set = std::getenv("OORT_DATASETS");
  const std::filesystem::path path = set != nullptr
                                         ? std::filesystem::path(set)
                                         : std::filesystem::path(__FILE__).parent_path() / "../../../shared/datasets";
  return std::filesystem::is_directory(path) ? path.string() : "";
}

}  // namespace oort::testing
