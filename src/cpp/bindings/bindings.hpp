// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "oort/geometry/pose2.hpp"
#include "oort/geometry/sweep.hpp"
#include "oort/loop_closure/statistics.hpp"
#include "oort/matching/rejection.hpp"

namespace oort {

/// A pose as Python has it: x, y, theta.
using PoseTuple = std::tuple<double, double, double>;

inline Pose2 pose_of(const PoseTuple& t) {
  return {std::get<0>(t), std::get<1>(t), std::get<2>(t)};
}
inline PoseTuple tuple_of(const Pose2& p) {
  return {p.x, p.y, p.theta};
}

/// A path as the operating system has it, whatever bytes that are.
struct PathText {
  std::string text;
};

/// The counts by their texts, in their order.
pybind11::dict dict_of(const RejectionCounts& counts);

/// The text of a verdict; none of what was accepted.
std::optional<std::string> text_of(Rejection rejection);

/// Tried, accepted, and rejected by reason.
pybind11::dict dict_of(const ClosureCounts& counts);

/// A sweep as Python has it: where the base was at the first beam and at the last.
using SweepTuple = std::optional<std::pair<PoseTuple, PoseTuple>>;

inline Sweep sweep_of(const SweepTuple& sweep) {
  return sweep ? Sweep{pose_of(sweep->first), pose_of(sweep->second)} : Sweep{};
}

/// A file's text need not be UTF-8; what is not becomes U+FFFD instead of an exception.
pybind11::str to_str(const std::string& text);

void bind_states(pybind11::module_& m);
void bind_parameters(pybind11::module_& m);
void bind_map(pybind11::module_& m);
void bind_graph(pybind11::module_& m);
void bind_odometry(pybind11::module_& m);
void bind_mapping(pybind11::module_& m);
void bind_localization(pybind11::module_& m);
void bind_sensor(pybind11::module_& m);
void bind_merging(pybind11::module_& m);

}  // namespace oort

namespace pybind11::detail {

/// From str, bytes or os.PathLike, as Python's own functions take paths.
template <>
struct type_caster<oort::PathText> {
  PYBIND11_TYPE_CASTER(oort::PathText, const_name("str"));

  bool load(handle source, bool /*convert*/) {
    object path = reinterpret_steal<object>(PyOS_FSPath(source.ptr()));
    for (const char* errors : {"surrogateescape", "surrogatepass"}) {
      if (!path || !PyUnicode_Check(path.ptr())) break;
      const object bytes = reinterpret_steal<object>(PyUnicode_AsEncodedString(path.ptr(), "utf-8", errors));
      if (bytes) path = bytes;
    }
    PyErr_Clear();
    if (!path || !PyBytes_Check(path.ptr())) return false;
    value.text = reinterpret_borrow<pybind11::bytes>(path);
    return true;
  }
};

}  // namespace pybind11::detail
