// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>

#include "bindings.hpp"
#include "guarded.hpp"
#include "oort/localization/localizer.hpp"
#include "oort/localization/relocalizer.hpp"
#include "scans.hpp"
#include "states.hpp"

namespace py = pybind11;

namespace oort {
namespace {

py::dict dict_of(const Support& s) {
  py::dict dict;
  dict["points"] = s.points;
  dict["inliers"] = s.inliers;
  dict["blocked"] = s.blocked;
  dict["in_free"] = s.in_free;
  dict["surfaces"] = s.surfaces;
  dict["turned"] = s.turned;
  return dict;
}

PlacedScan placed_scan(double time, double angle_min, double angle_increment, double range_min, double range_max,
                       const Ranges& ranges, const PoseTuple& T_odom_sensor, const SweepTuple& sweep) {
  const PointCloud cloud = to_point_cloud(scan_of(time, angle_min, angle_increment, range_min, range_max, ranges));
  return {deskew(cloud, sweep_of(sweep)), pose_of(T_odom_sensor)};
}

void bind_reference(py::module_& m) {
  py::class_<PlacedScan>(m, "PlacedScan", "A scan and where odometry saw it.")
      .def(py::init(&placed_scan), py::arg("time"), py::arg("angle_min"), py::arg("angle_increment"),
           py::arg("range_min"), py::arg("range_max"), py::arg("ranges"), py::arg("sensor_in_odom"),
           py::arg("sweep") = py::none(), "The sweep is the sensor's.");
  py::class_<ReferenceMap, std::shared_ptr<ReferenceMap>>(m, "ReferenceMap",
                                                          "A saved map made ready to find a robot on it.")
      .def(py::init([](const Map& map, const Parameters& parameters) {
             const Map snapshot = map;
             const Parameters copy = parameters;
             const py::gil_scoped_release release;
             return std::make_shared<ReferenceMap>(snapshot, copy);
           }),
           py::arg("map"), py::arg("parameters"), "Raises InputError if the map is empty or contradicts itself.");
}

void bind_relocalizer(py::module_& m) {
  py::class_<Hypothesis>(m, "Hypothesis", "A place of the map where scans fit.")
      .def_property_readonly(
          "T_map_sensor", [](const Hypothesis& h) { return tuple_of(h.T_map_sensor); }, "Of the newest scan.")
      .def_property_readonly(
          "covariance", [](const Hypothesis& h) -> py::array_t<double> { return py::cast(h.covariance); },
          "(3, 3) of x, y, theta, along the axes of the map.")
      .def_property_readonly(
          "support", [](const Hypothesis& h) { return h.support.value(); },
          "Share of the returns that fit, less the share that contradicts.")
      .def_property_readonly(
          "counts", [](const Hypothesis& h) { return dict_of(h.support); }, "What the support is made of.");
  py::class_<Relocalization>(m, "Relocalization", "What a search without a guess found.")
      .def_property_readonly(
          "found", [](const Relocalization& r) { return r.found(); }, "Whether there is an answer.")
      .def_property_readonly(
          "rejection", [](const Relocalization& r) { return text_of(r.rejection); },
          "Why there is none, for people: \"too_few_points\", \"no_match\", \"low_support\", \"ambiguous\" or "
          "\"imprecise\"; None if there is.")
      .def_readonly("best", &Relocalization::best, "The answer, or what was rejected; None if nothing fits.")
      .def_readonly("second", &Relocalization::second, "The next place apart from it, or None.");
  py::class_<Relocalizer>(m, "Relocalizer", "Finds the robot on a map without a guess. Thread-safe.")
      .def(py::init([](const std::shared_ptr<ReferenceMap>& map, const Parameters& parameters) {
             return std::make_unique<Relocalizer>(map, parameters);
           }),
           py::arg("map"), py::arg("parameters"))
      .def(
          "find", [](const Relocalizer& self, const std::vector<PlacedScan>& scans) { return self.find(scans); },
          py::arg("scans"), py::call_guard<py::gil_scoped_release>(),
          "Looks for one or a few scans, oldest first, joined by odometry; the answer is the newest one's pose.");
}

py::dict dict_of(const LocalizationStatistics& s) {
  py::dict dict;
  dict["scans"] = s.scans;
  dict["matched"] = s.matched;
  dict["searches"] = s.searches;
  dict["jumps"] = s.jumps;
  dict["match_rejections"] = dict_of(s.match_rejections);
  dict["search_rejections"] = dict_of(s.search_rejections);
  return dict;
}

std::optional<PoseTuple> tuple_of(const std::optional<Pose2>& pose) {
  return pose ? std::make_optional(tuple_of(*pose)) : std::nullopt;
}

void bind_localizer(py::module_& m) {
  using GuardedLocalizer = Guarded<Localizer>;
  py::class_<GuardedLocalizer> localizer(
      m, "Localizer",
      "Follows a robot on a map that does not change. Threads may share it: its calls are made "
      "one after the other.");
  bind_add_ranges(localizer);
  localizer
      .def(py::init([](const std::shared_ptr<ReferenceMap>& map, const Parameters& parameters, const PoseTuple& mount) {
             return std::make_unique<GuardedLocalizer>(map, parameters, pose_of(mount));
           }),
           py::arg("map"), py::arg("parameters"), py::arg("sensor_on_base") = PoseTuple{0.0, 0.0, 0.0})
      .def(
          "start_at",
          [](GuardedLocalizer& guard, const PoseTuple& pose, const Eigen::Matrix3d& covariance) {
            guard.aside([&](Localizer& l) { l.start_at(pose_of(pose), covariance); });
          },
          py::arg("sensor_on_map"), py::arg("covariance"),
          "Says about where the sensor is at the next scan; the covariance is along the axes of the map.")
      .def("start_searching", guarded(&Localizer::start_searching), "Forgets the pose.")
      .def_property_readonly(
          "state", [](GuardedLocalizer& guard) { return guard.with([](const Localizer& l) { return l.state(); }); },
          "How well the sensor's place is known.")
      .def_property_readonly(
          "T_map_sensor",
          [](GuardedLocalizer& guard) {
            return guard.with([](const Localizer& l) { return tuple_of(l.T_map_sensor()); });
          },
          "The sensor's pose at the latest scan; None while searching.")
      .def_property_readonly(
          "T_map_odom",
          [](GuardedLocalizer& guard) {
            return guard.with([](const Localizer& l) { return tuple_of(l.T_map_odom()); });
          },
          "Where odometry's frame is on the map; None while searching.")
      .def_property_readonly(
          "covariance",
          [](GuardedLocalizer& guard) -> py::array_t<double> {
            return py::cast(guard.with([](const Localizer& l) { return Eigen::Matrix3d(l.covariance()); }));
          },
          "(3, 3) of T_map_sensor, along the axes of the map.")
      .def_property_readonly("support", guarded(&Localizer::support), "How well the latest scan fitted, at most 1.")
      .def_property_readonly(
          "statistics",
          [](GuardedLocalizer& guard) {
            return guard.with([](const Localizer& l) { return dict_of(l.statistics()); });
          },
          "Counts since it was made.");
}

}  // namespace

void bind_localization(py::module_& m) {
  bind_reference(m);
  bind_relocalizer(m);
  bind_localizer(m);
}

}  // namespace oort
