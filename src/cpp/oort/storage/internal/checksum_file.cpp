// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/storage/internal/checksum_file.hpp"

#include <algorithm>
#include <sstream>

#include "oort/storage/paths.hpp"

namespace oort {
namespace {

constexpr std::size_t kDigits = 32;

/// md5sum escapes backslashes and line ends in a name and marks such a line with a leading backslash.
std::string line_of(const std::string& digest, const std::string& name) {
  std::string escaped;
  for (const char c : name) {
    if (c == '\\') {
      escaped += "\\\\";
    } else if (c == '\n') {
      escaped += "\\n";
    } else if (c == '\r') {
      escaped += "\\r";
    } else {
      escaped += c;
    }
  }
  return (escaped == name ? "" : "\\") + digest + "  " + escaped + "\n";
}

bool ends_with(const std::string& text, const std::string& suffix) {
  return text.size() >= suffix.size() && text.compare(text.size() - suffix.size(), suffix.size(), suffix) == 0;
}

bool is_digest(const std::string& text) {
  return text.size() == kDigits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

std::string format_checksums(const Checksums& checksums, const std::string& map_name,
                             const std::string& metadata_name) {
  return line_of(checksums.map, map_name) + line_of(checksums.metadata, metadata_name);
}

std::optional<Checksums> parse_checksums(const std::string& text) {
  Checksums checksums;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.front() == '\\') line.erase(0, 1);
    const std::string digest = line.substr(0, kDigits);
    if (!is_digest(digest)) return std::nullopt;
    if (ends_with(line, kMapSuffix)) checksums.map = digest;
    if (ends_with(line, kMetadataSuffix)) checksums.metadata = digest;
  }
  if (checksums.map.empty() || checksums.metadata.empty()) return std::nullopt;
  return checksums;
}

}  // namespace oort
