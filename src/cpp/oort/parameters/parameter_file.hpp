// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "oort/parameters/parameters.hpp"

namespace oort {

/// Reads a params.json. Keys that it does not give have their defaults.
///
/// The file is strict JSON, or takes these liberties: comments from #, // or a stray $ to the end of the line, a
/// missing comma between members, a comma after the last one, and a key given twice: the last one counts, and
/// `warnings`, where given, gets a sentence on it.
///
/// Throws ParameterError if the file cannot be read, a key is unknown or its value not allowed, or values contradict
/// each other. The message names the file, the line, the key's full path and, for an unknown key, the nearest known
/// one.
Parameters read_parameters(const std::string& path, std::vector<std::string>* warnings = nullptr);

}  // namespace oort
