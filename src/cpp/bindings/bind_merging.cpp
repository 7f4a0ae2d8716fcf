// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "oort/merging/merge.hpp"

namespace py = pybind11;

namespace oort {
namespace {

py::list list_of(const std::vector<DroppedLocation>& dropped) {
  py::list list;
  for (const DroppedLocation& d : dropped) list.append(py::make_tuple(to_str(d.name_space), to_str(d.id), d.distance));
  return list;
}

}  // namespace

void bind_merging(py::module_& m) {
  py::class_<Merged>(m, "Merged", "What came of merging two maps.")
      .def_property_readonly(
          "map", [](const Merged& merged) { return Map(merged.map); }, "The map of both; a copy.")
      .def_readonly("first_node_b", &Merged::first_node_b, "The nodes of the first map have the ids before it.")
      .def_property_readonly(
          "T_a_b", [](const Merged& merged) { return tuple_of(merged.placement.T_a_b); },
          "Where the second map was found on the first, before anything was solved.")
      .def_property_readonly(
          "found_by", [](const Merged& merged) { return merged.placement.found_by; },
          "\"given\", \"dock\" or \"search\"")
      .def_readonly("views", &Merged::views, "Views of one map that were looked for on the other.")
      .def_property_readonly(
          "views_that_fit", [](const Merged& merged) { return merged.placement.fits; }, "Where the map was found.")
      .def_property_readonly(
          "views_that_contradict", [](const Merged& merged) { return merged.placement.contradicts; },
          "Where the map was found.")
      .def_property_readonly(
          "closures", [](const Merged& merged) { return dict_of(merged.across); },
          "From the second map to the first: tried, accepted, and rejected by reason.")
      .def_readonly("closures_kept", &Merged::across_kept, "Accepted ones that are on at the last solution.")
      .def_property_readonly(
          "dropped", [](const Merged& merged) { return list_of(merged.dropped); },
          "(namespace, id, distance [m]) of each place of the second map that the first has already.");
  m.def(
      "merge_maps",
      [](const Map& a, const Map& b, const Parameters& parameters, const std::optional<PoseTuple>& T_a_b) {
        const Map snapshot_a = a, snapshot_b = b;  // other threads may change them meanwhile
        const Parameters copy = parameters;
        const py::gil_scoped_release release;
        return merge_maps(snapshot_a, snapshot_b, copy, T_a_b ? std::make_optional(pose_of(*T_a_b)) : std::nullopt);
      },
      py::arg("a"), py::arg("b"), py::arg("parameters") = Parameters(), py::arg("T_a_b") = py::none(),
      "Joins two maps of the same home into one in the frame of the first. T_a_b is about where the second one's "
      "origin lies on the first; found if not given. Raises InputError and ParameterError.");
}

}  // namespace oort
