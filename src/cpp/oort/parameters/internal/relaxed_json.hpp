// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "oort/parameters/table.hpp"

/// JSON as params.json is written in practice: strict, or with the liberties of its documentation. These are comments
/// from #, // or a stray $ to the end of the line, a missing comma between members, a comma after the last one, and a
/// key given twice (the last one wins). There are no arrays and no null: no parameter takes one.
namespace oort {

struct JsonMember;
using JsonSection = std::vector<JsonMember>;

/// One "key": value of a section, and the line of its key.
struct JsonMember {
  std::string key;
  int line = 0;
  std::variant<ParameterValue, JsonSection> value;
};

struct JsonFile {
  JsonSection root;
  std::vector<std::string> duplicates;  ///< a message for each key that was given twice
};

/// `source` is the file's name in messages. Throws ParameterError, which names it and the line, where the text cannot
/// be read.
JsonFile parse_relaxed_json(const std::string& text, const std::string& source);

}  // namespace oort
