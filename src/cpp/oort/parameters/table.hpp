// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "oort/parameters/parameters.hpp"

namespace oort {

using ParameterValue = std::variant<bool, std::int64_t, double, std::string>;

/// Both ends are allowed.
struct Range {
  double min;
  double max;
};

enum class ParameterStatus {
  kUsed,
  kNoEffect  ///< kept for the original's files: checked, without effect
};

/// One row of the table.
struct ParameterEntry {
  std::string path;  ///< "output_map.median.iter"
  std::string unit;  ///< "" where it has none
  ParameterValue default_value;
  ParameterValue documented_value;   ///< for Oort's own keys: the value that gives the documented behaviour
  std::optional<Range> range;        ///< of numbers
  std::vector<std::string> choices;  ///< of a text that takes only these
  std::string meaning;
  std::string reason;  ///< why the default differs from the documented value; "" where it does not
  ParameterStatus status = ParameterStatus::kUsed;
  bool own = false;  ///< Oort's own: not a key of the documented params.json
};

/// Every parameter once, in the order of params.json.
std::vector<ParameterEntry> parameter_table();

Parameters default_parameters();

/// Throws ParameterError if no parameter has this path.
ParameterValue get_parameter(const Parameters& parameters, const std::string& path);

/// Every path and its value, in the order of params.json.
std::vector<std::pair<std::string, ParameterValue>> parameter_values(const Parameters& parameters);

/// An integer is a number too, but not the other way round. Throws ParameterError, which names the path and what is
/// allowed, if the path is unknown, or the value of the wrong type, out of range or not among the choices.
void set_parameter(Parameters& parameters, const std::string& path, const ParameterValue& value);

/// Checks values against each other, which set_parameter() cannot. Throws ParameterError.
void check_parameters(const Parameters& parameters);

/// The message for a path that is in no table, with the nearest path or section that is.
std::string unknown_parameter(const std::string& path);

/// "bool", "integer", "number" or "string".
std::string type_name(const ParameterValue& value);

}  // namespace oort
