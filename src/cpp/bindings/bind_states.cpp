// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <initializer_list>
#include <string>

#include "bindings.hpp"
#include "states.hpp"

namespace py = pybind11;

namespace oort {
namespace {

std::string upper(std::string_view text) {
  std::string name(text);
  for (char& c : name) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return name;
}

template <typename State>
void bind_state(py::module_& m, const char* name, const char* doc, std::initializer_list<State> states) {
  py::dict members;
  for (const State state : states) members[py::str(upper(to_string(state)))] = std::string(to_string(state));
  const py::object made =
      py::module_::import("enum").attr("StrEnum")(name, members, py::arg("module") = m.attr("__name__"));
  made.attr("__doc__") = doc;
  m.attr(name) = made;
}

}  // namespace

void bind_states(py::module_& m) {
  bind_state(m, "TrackingState",
             "How well the sensor's place on the map is known: by what scans show, by odometry alone, or not.",
             {TrackingState::kTracking, TrackingState::kUncertain, TrackingState::kLost});
  bind_state(m, "ScanOutcome",
             "What a scan became: a node, a pose relative to the last node, or nothing as it has too few returns.",
             {ScanOutcome::kNode, ScanOutcome::kLocated, ScanOutcome::kSkipped});
  bind_state(m, "LocalizationState", "How well the sensor's place on a saved map is known.",
             {LocalizationState::kSearching, LocalizationState::kTracking, LocalizationState::kUncertain,
              LocalizationState::kLost});
}

py::handle member_of(const char* enum_name, std::string_view text) {
  const py::object members = py::module_::import("oort._core").attr(enum_name);
  return members(std::string(text)).release();
}

}  // namespace oort
