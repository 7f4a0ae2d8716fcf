// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <random>
#include <vector>

#include "frsm/tracker.hpp"
#include "scene.hpp"

/// What the tests of the tracker drive.
namespace frsm::test {

constexpr Sensor kSensor{181, kPi, 8.0, 0.01};

/// A drive on an oval through the room; 0.1 s, 7 cm and 6 degrees at most from scan to scan.
inline Pose oval(int i) {
  const double phase = 0.09 * i;
  return {0.9 * std::cos(phase) + 0.2, 0.55 * std::sin(phase) + 0.4,
          wrap(std::atan2(0.55 * std::cos(phase), -0.9 * std::sin(phase)))};
}

struct Step {
  Points body;
  Motion odometry;  // with noise
};

inline std::vector<Step> drive(const Scene& scene, int n, unsigned seed, const Sensor& sensor = kSensor) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<Step> steps;
  for (int i = 0; i < n; ++i) {
    Step step;
    step.body = scan(scene, oval(i), sensor, random);
    step.odometry.delta = between(oval(i > 0 ? i - 1 : 0), oval(i));
    step.odometry.delta.x *= 1.05;
    step.odometry.delta.y += 0.003 * noise(random);
    step.odometry.delta.theta = step.odometry.delta.theta * 0.95 + 0.005 * noise(random);
    step.odometry.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
    steps.push_back(step);
  }
  return steps;
}

inline Points standing_scan(unsigned seed) {
  std::mt19937 random(seed);
  return scan(room(), oval(0), kSensor, random);
}

}  // namespace frsm::test
