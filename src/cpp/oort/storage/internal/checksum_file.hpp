// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

namespace oort {

/// The MD5 digests of a map's two content files, as 32 hexadecimal digits each.
struct Checksums {
  std::string map;
  std::string metadata;
};

/// The text of a checksum file, as `md5sum <map_name> <metadata_name>` prints it.
std::string format_checksums(const Checksums& checksums, const std::string& map_name, const std::string& metadata_name);

/// The digests in a checksum file; nothing if one is missing or the text is something else. The files are told apart by
/// their suffixes, so that a map whose files were all renamed stays readable.
std::optional<Checksums> parse_checksums(const std::string& text);

}  // namespace oort
