// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace oort {

/// One token of a relaxed JSON file, and the line that it is in.
struct JsonToken {
  enum class Kind { kString, kWord, kMark, kEnd, kBad };

  Kind kind = Kind::kEnd;
  std::string text;  ///< as it stands in the file: a string with its quotes and escapes
  int line = 1;

  bool is_mark(const char* mark) const { return kind == Kind::kMark && text == mark; }
};

/// Cuts a text into tokens, without blanks and comments. After the last one comes kEnd, for ever.
class JsonTokens {
 public:
  explicit JsonTokens(std::string text) : text_(std::move(text)) {}

  JsonToken next();

 private:
  void skip_blanks_and_comments();
  std::size_t end_of_string() const;

  std::string text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// The text that a string token stands for, in UTF-8; or why there is none.
std::optional<std::string> unescape(const std::string& quoted, std::string& text);

/// A number as JSON writes it, whatever the program's locale; infinite where a double cannot hold it.
double real_of(const std::string& word);

/// Whether a text is UTF-8 throughout.
bool is_utf8(const std::string& text);

}  // namespace oort
