// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "oort/odometry/gyro_odometry.hpp"
#include "oort/odometry/odometry_buffer.hpp"

namespace py = pybind11;

namespace oort {
namespace {

void bind_buffer(py::module_& m) {
  py::class_<OdometryBuffer>(m, "OdometryBuffer", "Odometry poses by time, interpolated at a scan's stamp.")
      .def(py::init<double>(), py::arg("horizon") = 0.0,
           "Poses older than `horizon` [s] before the newest are dropped; 0 keeps all.")
      .def(
          "add",
          [](OdometryBuffer& b, double t, double x, double y, double theta) {
            b.add(t, {x, y, theta});
          },
          py::arg("time"), py::arg("x"), py::arg("y"), py::arg("theta"), "Adds T_odom_base at a time [s].")
      .def(
          "lookup",
          [](const OdometryBuffer& b, double t, double most_ahead) -> std::optional<PoseTuple> {
            const auto pose = b.lookup(t, most_ahead);
            return pose ? std::make_optional(tuple_of(*pose)) : std::nullopt;
          },
          py::arg("time"), py::arg("most_ahead") = 0.0,
          "T_odom_base (x, y, theta) at a time [s]; None outside the times held, but for up to `most_ahead` [s] after "
          "the newest pose, where the base goes on as the last poses moved.")
      .def("clear", &OdometryBuffer::clear)
      .def("__len__", &OdometryBuffer::size);
}

void bind_gyro(py::module_& m) {
  py::class_<GyroOdometry>(m, "GyroOdometry", "Odometry whose turns are those of a gyro.")
      .def(py::init<>())
      .def("add_gyro", &GyroOdometry::add_gyro, py::arg("time"), py::arg("yaw_rate"),
           "Adds a yaw rate of the base [rad/s] at a time [s].")
      .def(
          "add_odometry",
          [](GyroOdometry& g, double t, double x, double y, double theta) {
            g.add_odometry(t, {x, y, theta});
          },
          py::arg("time"), py::arg("x"), py::arg("y"), py::arg("theta"), "Adds T_odom_base at a time [s].")
      .def(
          "take",
          [](GyroOdometry& g) {
            std::vector<std::tuple<double, double, double, double>> poses;
            for (const TimedPose& p : g.take()) poses.emplace_back(p.time, p.pose.x, p.pose.y, p.pose.theta);
            return poses;
          },
          "The poses that are settled since the last call: time [s], x, y, theta of T_odom_base.")
      .def("flush", &GyroOdometry::flush, "Settles what is left, as the gyro tells nothing more.")
      .def("set_back", &GyroOdometry::set_back, py::arg("time"),
           "Odometry's clock was set back to a time [s]: poses not taken are gone, pose and bias go on.")
      .def_property_readonly("bias", &GyroOdometry::bias,
                             "Of the gyro [rad/s]; None until the base stood for a second.")
      .def_property_readonly("steps_by_gyro", &GyroOdometry::steps_by_gyro, "Steps that have the gyro's turn.")
      .def_property_readonly("steps_by_odometry", &GyroOdometry::steps_by_odometry, "Steps that have odometry's.");
}

}  // namespace

void bind_odometry(py::module_& m) {
  bind_buffer(m);
  bind_gyro(m);
}

}  // namespace oort
