// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

#include <string_view>

#include "oort/local_slam/local_slam.hpp"
#include "oort/local_slam/tracking_state.hpp"
#include "oort/localization/localizer.hpp"

namespace oort {

/// The member of an enum that bind_states() made, by its text. States are members of Python's enum.StrEnum, with the
/// texts that the engine has for them, so that they can be compared with text and go into JSON.
pybind11::handle member_of(const char* enum_name, std::string_view text);

}  // namespace oort

namespace pybind11::detail {

template <typename State>
struct state_caster {
  template <typename Given>
  static handle cast(Given&& state, return_value_policy /*policy*/, handle /*parent*/) {
    return oort::member_of(type_caster<State>::kName, to_string(state));
  }
};

template <>
struct type_caster<oort::TrackingState> : state_caster<oort::TrackingState> {
  static constexpr auto name = const_name("oort._core.TrackingState");
  static constexpr const char* kName = "TrackingState";
};

template <>
struct type_caster<oort::ScanOutcome> : state_caster<oort::ScanOutcome> {
  static constexpr auto name = const_name("oort._core.ScanOutcome");
  static constexpr const char* kName = "ScanOutcome";
};

template <>
struct type_caster<oort::LocalizationState> : state_caster<oort::LocalizationState> {
  static constexpr auto name = const_name("oort._core.LocalizationState");
  static constexpr const char* kName = "LocalizationState";
};

}  // namespace pybind11::detail
