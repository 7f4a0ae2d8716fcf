// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

namespace oort {

void bind_parameters(pybind11::module_& m);
void bind_map(pybind11::module_& m);
void bind_graph(pybind11::module_& m);
void bind_mapping(pybind11::module_& m);

}  // namespace oort
