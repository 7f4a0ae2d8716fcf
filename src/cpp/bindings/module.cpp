// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>

#include <exception>
#include <new>
#include <stdexcept>

#include "bindings.hpp"
#include "oort/geometry/errors.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_core, m) {
  m.doc() = "The engine of Oort. Use it through the modules of the package oort.";
  m.attr("__version__") = OORT_VERSION;

  auto root = py::register_exception<oort::Error>(m, "Error", PyExc_RuntimeError);
  root.doc() = "What Oort cannot do, and what to do about it.";
  py::register_exception<oort::ParameterError>(m, "ParameterError", root.ptr()).doc() =
      "A parameter or an option has a value that it cannot have.";
  py::register_exception<oort::MapFileError>(m, "MapFileError", root.ptr()).doc() =
      "A map cannot be read or written: its files are missing, damaged or of another program.";
  py::register_exception<oort::InputError>(m, "InputError", root.ptr()).doc() =
      "Input cannot be used: a recording, a scan, a pose, a graph.";
  py::register_exception<oort::StateError>(m, "StateError", root.ptr()).doc() =
      "A call does not fit the state: nothing is being mapped, there is a map already, there is no such place.";
  static PyObject* const input_error = m.attr("InputError").ptr();
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
      PyErr_SetString(input_error, "it takes more memory than there is; give less, or look for a broken number in it");
    } catch (const std::logic_error& error) {  // frsm's, of numbers that no sensor measures
      PyErr_SetString(input_error, error.what());
    }
  });

  oort::bind_states(m);
  oort::bind_parameters(m);
  oort::bind_map(m);
  oort::bind_graph(m);
  oort::bind_odometry(m);
  oort::bind_mapping(m);
  oort::bind_localization(m);
  oort::bind_sensor(m);
  oort::bind_merging(m);
}
