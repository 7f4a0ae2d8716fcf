// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// 05: finds a robot on a saved map without a guess and follows it; the map does not change.
#include <cmath>
#include <cstdio>
#include <memory>
#include <oort/oort.hpp>
#include <string>

#include "carmen_log.hpp"
#include "example_main.hpp"

namespace {

void localise(const std::string& log_path, const std::string& map_path) {
  const CarmenLog log = read_carmen_log(log_path);
  const oort::Map map = oort::load_map(map_path);
  const oort::Parameters parameters;
  const auto reference = std::make_shared<const oort::ReferenceMap>(map, parameters);
  oort::Localizer localizer(reference, parameters, log.T_base_sensor);

  std::size_t known = 0;
  for (const LoggedScan& logged : log.scans) {
    const oort::LocalizationState state = localizer.add_scan(logged.scan, logged.T_odom_base);
    known += state == oort::LocalizationState::kTracking;
  }
  std::printf("%zu scans, %zu of them tracked\n", log.scans.size(), known);
  if (!localizer.T_map_sensor()) throw oort::InputError("the robot was not found on the map");
  const oort::Pose2 T_map_base = *localizer.T_map_sensor() * oort::inverse(log.T_base_sensor);
  const std::string state(oort::to_string(localizer.state()));
  std::printf("%s: the base is at %.2f %.2f, give or take %.2f m\n", state.c_str(), T_map_base.x, T_map_base.y,
              std::sqrt(localizer.covariance()(0, 0) + localizer.covariance()(1, 1)));
}

}  // namespace

int main(int argc, char** argv) {
  return example_main(argc, argv, localise);
}
