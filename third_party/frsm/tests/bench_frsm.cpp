// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Prints what the parts of a match cost. Nothing is asserted: figures depend on the machine.
#include <algorithm>

#include <cstdio>
#include <ctime>
#include <functional>
#include <vector>

#include "frsm/tracker.hpp"
#include "scene.hpp"

namespace {

using frsm::Pose;

// Median and 99th percentile of a function's processor time over many calls. [ms]
void report(const char* what, int calls, const std::function<void(int)>& function) {
  std::vector<double> times;
  for (int i = 0; i < calls; ++i) {
    const std::clock_t start = std::clock();
    function(i);
    times.push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::sort(times.begin(), times.end());
  std::printf("%-58s median %8.3f ms   p99 %8.3f ms\n", what, times[times.size() / 2], times[times.size() * 99 / 100]);
}

void bench_scan_size(int beams) {
  std::mt19937 random(1);
  const frsm::test::Scene scene = frsm::test::room(0.3);
  const frsm::test::Sensor sensor{beams, frsm::test::kPi, 8.0, 0.01};
  const Pose truth{0.2, 0.3, 0.4};
  const frsm::Points points = frsm::test::scan(scene, truth, sensor, random);
  const frsm::Points world = frsm::transform(truth, points);
  const frsm::ContourParams contour_params;
  const auto contours = frsm::extract_contours(points, contour_params);
  frsm::Table table;
  std::printf("\n%zu points\n", points.size());
  report("contours", 300, [&](int) { frsm::extract_contours(points, contour_params); });
  report("draw into one table", 300, [&](int) { table.draw(world, contours, truth); });

  const frsm::Pose guess{0.24, 0.27, 0.43};
  const frsm::Prior prior{guess, Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal()};
  const frsm::Matcher matcher;
  report("match, window 0.1 m, 0.1 rad (11 x 11 x 21)", 300, [&](int) {
    matcher.match(table, points, guess, {0.1, 0.1, 0.1}, &prior);
  });
  report("match, window 0.3 m, 0.3 rad (31 x 31 x 61)", 50, [&](int) {
    matcher.match(table, points, guess, {0.3, 0.3, 0.3}, &prior);
  });
  for (const bool bounded : {false, true}) {
    frsm::MatcherParams params;
    params.exhaustive_limit = bounded ? 1 : 1 << 30;
    params.two_level_limit = 0;
    const frsm::Matcher forced(params);
    report(bounded ? "match, window 1 m, 0.3 rad, branch and bound" : "match, window 1 m, 0.3 rad, exhaustive", 20,
           [&](int) {
             forced.match(table, points, guess, {1.0, 1.0, 0.3}, nullptr);
           });
  }
  report("match, window 4 m, all headings, branch and bound", 10, [&](int) {
    matcher.match(table, points, {1.0, -0.5, 2.0}, {4.0, 4.0, frsm::test::kPi}, nullptr);
  });
  frsm::MatcherParams wary;
  wary.ambiguity_floor = 0.7;
  report("the same with a look for a second peak above 0.7", 10, [&](int) {
    frsm::Matcher(wary).match(table, points, {1.0, -0.5, 2.0}, {4.0, 4.0, frsm::test::kPi}, nullptr);
  });
}

void bench_tracker(int beams) {
  std::mt19937 random(2);
  const frsm::test::Scene scene = frsm::test::room(0.3);
  const frsm::test::Sensor sensor{beams, frsm::test::kPi, 8.0, 0.01};
  std::vector<frsm::Points> scans;
  constexpr int kScans = 600;
  const auto pose = [](int i) { return Pose{0.9 * std::cos(0.01 * i), 0.6 * std::sin(0.01 * i), 0.01 * i + 1.57}; };
  for (int i = 0; i < kScans; ++i) scans.push_back(frsm::test::scan(scene, pose(i), sensor, random));
  frsm::Tracker tracker;
  tracker.reset(pose(0));
  report("track, with odometry and additions to the map", kScans, [&](int i) {
    frsm::Motion motion{frsm::between(pose(std::max(0, i - 1)), pose(i)), Eigen::Matrix3d::Identity() * 1e-6};
    tracker.track(scans[i], 0.1 * i, motion);
  });
  std::printf("  %ld scans added, %ld retries\n", tracker.added_scans(), tracker.retries());
}

}  // namespace

int main() {
  for (const int beams : {181, 361}) {
    bench_scan_size(beams);
    bench_tracker(beams);
  }
}
