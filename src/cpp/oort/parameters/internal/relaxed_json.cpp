// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/parameters/internal/relaxed_json.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <regex>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/parameters/internal/json_tokens.hpp"

namespace oort {
namespace {

constexpr int kMaxDepth = 20;
constexpr std::size_t kMaxIntegerLength = 18;  // longer ones do not fit 64 bits; as reals they are refused by range

/// A number as JSON writes it; nothing for other words.
std::optional<ParameterValue> number(const std::string& word) {
  static const std::regex kNumber(R"(-?(0|[1-9][0-9]*)((\.[0-9]+)?([eE][-+]?[0-9]+)?))");
  std::smatch match;
  if (!std::regex_match(word, match, kNumber)) return std::nullopt;
  if (match[2].length() == 0 && word.size() <= kMaxIntegerLength) return std::int64_t{std::stoll(word)};
  return real_of(word);
}

class Parser {
 public:
  Parser(const std::string& text, const std::string& source) : tokens_(text), source_(source) { advance(); }

  JsonFile parse() {
    JsonFile file;
    file.root = section("", 0);
    if (next_.kind != JsonToken::Kind::kEnd) fail("the end of the file");
    file.duplicates = std::move(duplicates_);
    return file;
  }

 private:
  JsonSection section(const std::string& prefix, int depth) {
    expect("{");
    if (depth > kMaxDepth) fail("fewer sections inside each other");
    JsonSection members;
    while (!accept("}")) {
      if (next_.kind != JsonToken::Kind::kString) fail("\"key\" or }");
      JsonMember member;
      member.line = next_.line;
      member.key = text(advance());
      expect(":");
      const auto first =
          std::find_if(members.begin(), members.end(), [&](const JsonMember& m) { return m.key == member.key; });
      if (first != members.end()) {
        duplicates_.push_back(where(member.line) + prefix + member.key + " was given in line " +
                              std::to_string(first->line) + "; this one counts");
      }
      member.value = value(prefix + member.key, depth);
      if (first != members.end()) {
        *first = std::move(member);
      } else {
        members.push_back(std::move(member));
      }
      accept(",");
    }
    return members;
  }

  std::variant<ParameterValue, JsonSection> value(const std::string& path, int depth) {
    if (next_.is_mark("{")) return section(path + ".", depth + 1);
    if (next_.kind == JsonToken::Kind::kString) return ParameterValue(text(advance()));
    if (next_.kind == JsonToken::Kind::kWord) {
      if (next_.text == "true" || next_.text == "false") return ParameterValue(advance().text == "true");
      if (const auto found = number(next_.text)) {
        advance();
        return *found;
      }
    }
    fail("the value of " + path + ": true, false, a number, a \"text\" or {");
  }

  std::string text(const JsonToken& token) const {
    std::string unescaped;
    if (const auto why = unescape(token.text, unescaped)) {
      throw ParameterError(where(token.line) + "bad string " + token.text + ": " + *why);
    }
    return unescaped;
  }

  bool accept(const char* mark) {
    const bool found = next_.is_mark(mark);
    if (found) advance();
    return found;
  }

  void expect(const char* mark) {
    if (!accept(mark)) fail(mark);
  }

  JsonToken advance() { return std::exchange(next_, tokens_.next()); }

  std::string where(int line) const { return source_ + ":" + std::to_string(line) + ": "; }

  [[noreturn]] void fail(const std::string& expected) const {
    const bool at_end = next_.kind == JsonToken::Kind::kEnd;
    throw ParameterError(where(next_.line) + "expected " + expected + ", found " +
                         (at_end ? "the end of the file" : next_.text));
  }

  JsonTokens tokens_;
  std::string source_;
  JsonToken next_;
  std::vector<std::string> duplicates_;
};

}  // namespace

JsonFile parse_relaxed_json(const std::string& text, const std::string& source) {
  return Parser(text, source).parse();
}

}  // namespace oort
