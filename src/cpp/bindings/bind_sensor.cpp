// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <vector>

#include "bindings.hpp"
#include "oort/sensor/scan_pair.hpp"
#include "scans.hpp"

namespace py = pybind11;

namespace oort {
namespace {

PointCloud cloud_of(double time, double angle_min, double angle_increment, double range_min, double range_max,
                    const Ranges& ranges) {
  return to_point_cloud(scan_of(time, angle_min, angle_increment, range_min, range_max, ranges));
}

}  // namespace

void bind_sensor(py::module_& m) {
  py::class_<ReferenceScan>(m, "ReferenceScan", "A scan that others are laid on by themselves, without a map.")
      .def(py::init([](double time, double angle_min, double angle_increment, double range_min, double range_max,
                       const Ranges& ranges) {
             return ReferenceScan(cloud_of(time, angle_min, angle_increment, range_min, range_max, ranges));
           }),
           py::arg("time"), py::arg("angle_min"), py::arg("angle_increment"), py::arg("range_min"),
           py::arg("range_max"), py::arg("ranges"))
      .def(
          "align",
          [](const ReferenceScan& reference, double time, double angle_min, double angle_increment, double range_min,
             double range_max, const Ranges& ranges, const std::vector<PoseTuple>& guesses) {
            if (guesses.empty()) throw py::value_error("align: needs a guess");
            std::vector<Pose2> poses(guesses.size());
            std::transform(guesses.begin(), guesses.end(), poses.begin(), pose_of);
            const PairMatch best =
                reference.align_best(cloud_of(time, angle_min, angle_increment, range_min, range_max, ranges), poses,
                                     SensorTuning::kPointsOfPairs);
            return py::make_tuple(tuple_of(best.T_reference_scan), best.misfit, best.inlier_ratio, best.degenerate);
          },
          py::arg("time"), py::arg("angle_min"), py::arg("angle_increment"), py::arg("range_min"), py::arg("range_max"),
          py::arg("ranges"), py::arg("guesses"),
          "Lays a scan on this one from some guesses (T_reference_scan): the pose that fits best, the mean squared "
          "distance of the points that lie on the reference [m^2], their share, and whether a direction is left open.");
}

}  // namespace oort
