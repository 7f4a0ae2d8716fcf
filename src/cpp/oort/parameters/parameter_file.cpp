// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/parameters/parameter_file.hpp"

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/parameters/internal/json_tokens.hpp"
#include "oort/parameters/internal/relaxed_json.hpp"
#include "oort/parameters/table.hpp"

namespace oort {
namespace {

constexpr std::uintmax_t kMaxSize = 1 << 20;  // [bytes]
constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";

std::string content_of(const std::string& path) {
  const auto fail = [&](const std::string& why) {
    throw ParameterError("cannot read the parameters " + path + ": " + why);
  };
  if (path.find('\0') != std::string::npos) fail("a path has no character 0");
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) fail(std::strerror(error ? error.value() : ENOENT));
  if (std::filesystem::is_directory(status)) fail(std::strerror(EISDIR));
  if (!std::filesystem::is_regular_file(status)) fail("it is a device or a pipe; give a file");
  if (std::filesystem::file_size(path, error) > kMaxSize || error) fail("it is larger than any file of parameters");
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail(std::strerror(errno));
  std::string text;
  char buffer[4096];
  do {  // by hand: only so is an error told from the end, as where the path is a folder
    stream.read(buffer, sizeof buffer);
    text.append(buffer, static_cast<std::size_t>(stream.gcount()));
  } while (stream);
  if (stream.bad()) fail(std::strerror(errno));
  if (!is_utf8(text)) fail("it is not UTF-8 text");
  if (text.compare(0, 3, kByteOrderMark) == 0) text.erase(0, 3);
  return text;
}

class Reader {
 public:
  explicit Reader(std::string source) : source_(std::move(source)) {
    for (const ParameterEntry& entry : parameter_table()) {
      types_[entry.path] = type_name(entry.default_value);
      for (std::size_t k = entry.path.find('.'); k != std::string::npos; k = entry.path.find('.', k + 1)) {
        sections_.insert(entry.path.substr(0, k));
      }
    }
  }

  Parameters read(const JsonSection& root) {
    apply(root, "");
    try {
      check_parameters(parameters_);
    } catch (const ParameterError& error) {
      throw ParameterError(source_ + ": " + error.what());
    }
    return parameters_;
  }

 private:
  void apply(const JsonSection& section, const std::string& prefix) {
    for (const JsonMember& member : section) {
      const std::string path = prefix + member.key;
      const auto* inner = std::get_if<JsonSection>(&member.value);
      try {
        check(member, path, inner != nullptr);
        if (inner == nullptr) set_parameter(parameters_, path, whole(path, std::get<ParameterValue>(member.value)));
      } catch (const ParameterError& error) {
        throw ParameterError(source_ + ":" + std::to_string(member.line) + ": " + error.what());
      }
      if (inner != nullptr) apply(*inner, path + ".");
    }
  }

  /// 3.0 counts as 3 where an integer is meant, as programs that write JSON have it.
  ParameterValue whole(const std::string& path, const ParameterValue& value) const {
    const double* real = std::get_if<double>(&value);
    const bool is_whole = real != nullptr && std::trunc(*real) == *real && std::abs(*real) < 1e15;
    return is_whole && types_.at(path) == "integer" ? ParameterValue(static_cast<std::int64_t>(*real)) : value;
  }

  void check(const JsonMember& member, const std::string& path, bool is_section) const {
    const auto type = types_.find(path);
    const bool is_known = type != types_.end() || sections_.count(path) > 0;
    if (member.key.find('.') != std::string::npos || !is_known) throw ParameterError(unknown_parameter(path));
    if (is_section && type != types_.end()) {
      throw ParameterError(path + ": takes one value (" + type->second + "), not a section { }");
    }
    if (!is_section && type == types_.end()) throw ParameterError(path + ": is a section; it takes { }, not one value");
  }

  std::string source_;
  Parameters parameters_;
  std::map<std::string, std::string> types_;  // of each path
  std::set<std::string> sections_;
};

}  // namespace

Parameters read_parameters(const std::string& path, std::vector<std::string>* warnings) {
  const JsonFile file = parse_relaxed_json(content_of(path), path);
  if (warnings != nullptr) *warnings = file.duplicates;
  return Reader(path).read(file.root);
}

}  // namespace oort
