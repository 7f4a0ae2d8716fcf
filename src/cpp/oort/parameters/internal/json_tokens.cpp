// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/parameters/internal/json_tokens.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <system_error>

namespace oort {
namespace {

/// Letters of other scripts count as letters, so that a message shows such a word whole.
bool is_word_letter(char c) {
  const bool is_ascii_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  return is_ascii_letter || c == '_' || c == '-' || c == '+' || c == '.' || static_cast<unsigned char>(c) >= 0x80;
}

void append_utf8(std::uint32_t code, std::string& text) {
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xC0 | (code >> 6));
    text += static_cast<char>(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    text += static_cast<char>(0xE0 | (code >> 12));
    text += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
    text += static_cast<char>(0x80 | (code & 0x3F));
  } else {
    text += static_cast<char>(0xF0 | (code >> 18));
    text += static_cast<char>(0x80 | ((code >> 12) & 0x3F));
    text += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
    text += static_cast<char>(0x80 | (code & 0x3F));
  }
}

/// The four hexadecimal digits from a place on.
std::optional<std::uint32_t> hex4(const std::string& text, std::size_t at) {
  if (at + 4 > text.size()) return std::nullopt;
  std::uint32_t code = 0;
  const char* end = text.data() + at + 4;
  const auto [stop, error] = std::from_chars(text.data() + at, end, code, 16);
  if (error != std::errc() || stop != end) return std::nullopt;
  return code;
}

/// The character of a \u escape whose digits begin at a place, which is moved behind it. A pair of surrogates is one.
std::optional<std::uint32_t> escaped_code(const std::string& text, std::size_t& at) {
  const auto high = hex4(text, at);
  if (!high) return std::nullopt;
  at += 4;
  if (*high < 0xD800 || *high > 0xDFFF) return high;
  const bool is_followed = *high < 0xDC00 && text.compare(at, 2, "\\u") == 0;
  const auto low = is_followed ? hex4(text, at + 2) : std::nullopt;
  if (!low || *low < 0xDC00 || *low > 0xDFFF) return std::nullopt;
  at += 6;
  return 0x10000 + ((*high - 0xD800) << 10) + (*low - 0xDC00);
}

}  // namespace

void JsonTokens::skip_blanks_and_comments() {
  while (at_ < text_.size()) {
    const char c = text_[at_];
    if (std::strchr(" \t\n\r\v\f", c) != nullptr && c != '\0') {
      line_ += c == '\n';
      ++at_;
    } else if (c == '#' || c == '$' || text_.compare(at_, 2, "//") == 0) {
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else {
      return;
    }
  }
}

/// Behind the closing quote of the string that begins here; npos if the line ends before.
std::size_t JsonTokens::end_of_string() const {
  for (std::size_t k = at_ + 1; k < text_.size() && text_[k] != '\n'; ++k) {
    if (text_[k] == '"') return k + 1;
    if (text_[k] == '\\' && k + 1 < text_.size() && text_[k + 1] != '\n') ++k;
  }
  return std::string::npos;
}

JsonToken JsonTokens::next() {
  skip_blanks_and_comments();
  if (at_ == text_.size()) return {JsonToken::Kind::kEnd, "", line_};
  JsonToken::Kind kind = JsonToken::Kind::kBad;
  std::size_t end = at_ + 1;
  if (std::strchr("[]{}:,", text_[at_]) != nullptr && text_[at_] != '\0') {
    kind = JsonToken::Kind::kMark;
  } else if (text_[at_] == '"') {
    const std::size_t closed = end_of_string();
    if (closed != std::string::npos) {
      kind = JsonToken::Kind::kString;
      end = closed;
    }
  } else if (is_word_letter(text_[at_])) {
    kind = JsonToken::Kind::kWord;
    while (end < text_.size() && is_word_letter(text_[end])) ++end;
  }
  const std::size_t begin = std::exchange(at_, end);
  return {kind, text_.substr(begin, end - begin), line_};
}

std::optional<std::string> unescape(const std::string& quoted, std::string& text) {
  static const std::string kEscapes = "\"\\/bfnrt", kMeanings = "\"\\/\b\f\n\r\t";
  for (std::size_t k = 1; k + 1 < quoted.size();) {
    const char c = quoted[k++];
    if (static_cast<unsigned char>(c) < 0x20) return "a control character must be escaped";
    if (c != '\\') {
      text += c;
      continue;
    }
    const char escape = quoted[k++];
    if (escape == 'u') {
      const auto code = escaped_code(quoted, k);
      if (!code) return "\\u takes four hexadecimal digits, and surrogates come in pairs";
      append_utf8(*code, text);
    } else if (const std::size_t which = kEscapes.find(escape); which != std::string::npos) {
      text += kMeanings[which];
    } else {
      return "there is no escape \\" + std::string(1, escape);
    }
  }
  return std::nullopt;
}

double real_of(const std::string& word) {
  double value = 0.0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc::result_out_of_range) return value;
  if (word.find("e-") != std::string::npos || word.find("E-") != std::string::npos) return 0.0;
  return word.front() == '-' ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
}

bool is_utf8(const std::string& text) {
  for (std::size_t k = 0; k < text.size();) {
    const auto first = static_cast<unsigned char>(text[k]);
    const int more = first < 0x80 ? 0 : first < 0xC2 ? -1 : first < 0xE0 ? 1 : first < 0xF0 ? 2 : first < 0xF5 ? 3 : -1;
    if (more < 0 || k + static_cast<std::size_t>(more) >= text.size()) return false;
    for (int i = 1; i <= more; ++i) {
      if ((static_cast<unsigned char>(text[k + static_cast<std::size_t>(i)]) & 0xC0) != 0x80) return false;
    }
    k += static_cast<std::size_t>(more) + 1;
  }
  return true;
}

}  // namespace oort
