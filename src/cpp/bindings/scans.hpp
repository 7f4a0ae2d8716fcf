// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <vector>

#include "bindings.hpp"
#include "guarded.hpp"
#include "oort/geometry/point_cloud.hpp"

namespace oort {

using Ranges = pybind11::array_t<float, pybind11::array::c_style | pybind11::array::forcecast>;

/// A scan of the fields that Python calls give one by one, so that ranges arrive as an array.
inline LaserScan scan_of(double time, double angle_min, double angle_increment, double range_min, double range_max,
                         const Ranges& ranges) {
  return {time,      angle_min, angle_increment,
          range_min, range_max, std::vector<float>(ranges.data(), ranges.data() + ranges.size())};
}

/// How an engine that odometry leads takes scans: of its main laser and of others.
template <typename Engine>
void bind_add_ranges(pybind11::class_<Guarded<Engine>>& c) {
  namespace py = pybind11;
  c.def(
       "add_ranges",
       [](Guarded<Engine>& guard, double time, double angle_min, double angle_increment, double range_min,
          double range_max, const Ranges& ranges, const PoseTuple& odometry, const SweepTuple& sweep) {
         const LaserScan scan = scan_of(time, angle_min, angle_increment, range_min, range_max, ranges);
         return guard.aside([&](Engine& engine) { return engine.add_scan(scan, pose_of(odometry), sweep_of(sweep)); });
       },
       py::arg("time"), py::arg("angle_min"), py::arg("angle_increment"), py::arg("range_min"), py::arg("range_max"),
       py::arg("ranges"), py::arg("odometry"), py::arg("sweep") = py::none(),
       "Takes the next scan with T_odom_base at its stamp and, for one whose beams were not measured at once, where "
       "the base was at the first and at the last beam, seen from where it was at the stamp. Raises InputError; "
       "nothing changes then.")
      .def(
          "add_ranges_of_other",
          [](Guarded<Engine>& guard, const PoseTuple& mount, double time, double angle_min, double angle_increment,
             double range_min, double range_max, const Ranges& ranges, const PoseTuple& odometry,
             const SweepTuple& sweep) {
            const LaserScan scan = scan_of(time, angle_min, angle_increment, range_min, range_max, ranges);
            guard.aside([&](Engine& engine) {
              engine.add_scan_of_other(pose_of(mount), scan, pose_of(odometry), sweep_of(sweep));
            });
          },
          py::arg("sensor_on_base"), py::arg("time"), py::arg("angle_min"), py::arg("angle_increment"),
          py::arg("range_min"), py::arg("range_max"), py::arg("ranges"), py::arg("odometry"),
          py::arg("sweep") = py::none(),
          "Takes a scan of another laser, which joins the next one of the main laser. Raises InputError.");
}

}  // namespace oort
