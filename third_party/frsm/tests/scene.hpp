// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "frsm/types.hpp"

namespace frsm::test {

constexpr double kPi = 3.14159265358979323846;

struct Wall {
  Point a, b;
};
using Scene = std::vector<Wall>;

struct Sensor {
  int beams = 181;
  double fov = kPi;    // [rad]
  double range = 8.0;  // [m]
  double noise = 0.0;  // standard deviation of a range [m]
};

inline double distance_to_wall(const Point& origin, double angle, const Wall& wall) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const double ex = wall.b.x - wall.a.x;
  const double ey = wall.b.y - wall.a.y;
  const double det = c * -ey + s * ex;
  const double dx = wall.a.x - origin.x;
  const double dy = wall.a.y - origin.y;
  const double range = (dx * -ey + dy * ex) / det;
  const double along = (c * dy - s * dx) / det;
  const bool hit = std::abs(det) > 1e-12 && range > 0.0 && along >= 0.0 && along <= 1.0;
  return hit ? range : std::numeric_limits<double>::infinity();
}

/// What a sensor at a pose sees: points in its own frame, by increasing bearing.
inline Points scan(const Scene& scene, const Pose& pose, const Sensor& sensor, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 1.0);
  Points points;
  for (int i = 0; i < sensor.beams; ++i) {
    const double bearing = sensor.fov * (static_cast<double>(i) / (sensor.beams - 1) - 0.5);
    double range = std::numeric_limits<double>::infinity();
    for (const Wall& wall : scene) {
      range = std::min(range, distance_to_wall({pose.x, pose.y}, pose.theta + bearing, wall));
    }
    const double error = sensor.noise * noise(random);
    if (range > sensor.range) continue;
    points.push_back({(range + error) * std::cos(bearing), (range + error) * std::sin(bearing)});
  }
  return points;
}

inline void add_box(Scene* scene, const Pose& centre, double width, double depth) {
  const Point corners[4] = {centre * Point{-width / 2, -depth / 2}, centre * Point{width / 2, -depth / 2},
                            centre * Point{width / 2, depth / 2}, centre * Point{-width / 2, depth / 2}};
  for (int i = 0; i < 4; ++i) scene->push_back({corners[i], corners[(i + 1) % 4]});
}

/// A furnished room of 6 m x 4.4 m with a cupboard and a table, turned by an angle about the origin.
inline Scene room(double turn = 0.0) {
  Scene scene;
  const Pose frame{0.0, 0.0, turn};
  add_box(&scene, frame * Pose{0.3, -0.1, 0.0}, 6.0, 4.4);
  add_box(&scene, frame * Pose{2.4, 1.6, 0.0}, 0.8, 0.7);
  add_box(&scene, frame * Pose{-1.3, -1.2, 0.5}, 1.1, 0.6);
  return scene;
}

/// Two parallel walls along x, without an end in sight from near the origin.
inline Scene corridor(double length = 30.0, double width = 1.8) {
  return {{{-length / 2, -width / 2}, {length / 2, -width / 2}}, {{length / 2, width / 2}, {-length / 2, width / 2}}};
}

/// The angle between the headings of two poses [rad].
inline double turn(const Pose& a, const Pose& b) {
  return std::abs(wrap(a.theta - b.theta));
}

}  // namespace frsm::test
