// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "oort/parameters/parameter_file.hpp"
#include "oort/parameters/table.hpp"

namespace py = pybind11;

namespace oort {
namespace {

const char* status_name(ParameterStatus status) {
  switch (status) {
    case ParameterStatus::kNoEffect:
      return "no_effect";
    default:
      return "used";
  }
}

std::optional<double> min_of(const ParameterEntry& entry) {
  return entry.range ? std::optional(entry.range->min) : std::nullopt;
}

std::optional<double> max_of(const ParameterEntry& entry) {
  return entry.range ? std::optional(entry.range->max) : std::nullopt;
}

py::dict to_dict(const Parameters& parameters) {
  py::dict values;
  for (const auto& [path, value] : parameter_values(parameters)) values[py::str(path)] = value;
  return values;
}

void bind_entry(py::module_& m) {
  using Entry = ParameterEntry;
  py::class_<Entry>(m, "ParameterEntry", "One row of the table of parameters.")
      .def_readonly("path", &Entry::path)
      .def_property_readonly("type", [](const Entry& entry) { return type_name(entry.default_value); })
      .def_readonly("unit", &Entry::unit)
      .def_readonly("default", &Entry::default_value)
      .def_readonly("documented", &Entry::documented_value)
      .def_property_readonly("min", &min_of)
      .def_property_readonly("max", &max_of)
      .def_readonly("choices", &Entry::choices)
      .def_readonly("meaning", &Entry::meaning)
      .def_readonly("reason", &Entry::reason)
      .def_property_readonly("status", [](const Entry& entry) { return status_name(entry.status); })
      .def_readonly("own", &Entry::own);
}

}  // namespace

void bind_parameters(py::module_& m) {
  bind_entry(m);
  m.def("parameter_table", &parameter_table, "Every parameter once, in the order of params.json.");
  m.def(
      "unknown_parameter", [](const std::string& path) { return to_str(unknown_parameter(path)); }, py::arg("path"),
      "The message for a path that is in no table, with the nearest path or section that is.");
  py::class_<Parameters>(m, "Parameters", "The parameters of the engine, by their paths in params.json.")
      .def(py::init<>(), "Every value at its default.")
      .def("get", &get_parameter, py::arg("path"), "The value at a path. Raises ParameterError if it is unknown.")
      // Without noconvert pybind11 would take any object for a bool.
      .def("set", &set_parameter, py::arg("path"), py::arg("value").noconvert(),
           "Sets the value at a path. Raises ParameterError if the path is unknown or the value not allowed.")
      .def("check", &check_parameters, "Checks values against each other. Raises ParameterError.")
      .def("copy", [](const Parameters& self) { return Parameters(self); })
      .def("to_dict", &to_dict, "Every path and its value, in the order of params.json.");
  m.def(
      "read_parameters",
      [](const PathText& path) {
        std::vector<std::string> warnings;
        Parameters parameters = read_parameters(path.text, &warnings);
        return std::make_pair(std::move(parameters), std::move(warnings));
      },
      py::arg("path"),
      "The parameters of a file, and a sentence on each key that it gives twice. Raises ParameterError.");
}

}  // namespace oort
