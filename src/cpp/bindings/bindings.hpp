// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

#include <string>
#include <tuple>

#include "oort/geometry/pose2.hpp"
#include "oort/mapping/statistics.hpp"

namespace oort {

/// A pose as Python has it: x, y, theta.
using PoseTuple = std::tuple<double, double, double>;

inline Pose2 pose_of(const PoseTuple& t) {
  return {std::get<0>(t), std::get<1>(t), std::get<2>(t)};
}
inline PoseTuple tuple_of(const Pose2& p) {
  return {p.x, p.y, p.theta};
}

/// Tried, accepted, and refused by reason.
pybind11::dict dict_of(const ClosureCounts& counts);

/// A file's text need not be UTF-8; what is not becomes U+FFFD instead of an exception.
pybind11::str to_str(const std::string& text);

void bind_parameters(pybind11::module_& m);
void bind_map(pybind11::module_& m);
void bind_graph(pybind11::module_& m);
void bind_mapping(pybind11::module_& m);
void bind_localization(pybind11::module_& m);
void bind_merging(pybind11::module_& m);

}  // namespace oort
