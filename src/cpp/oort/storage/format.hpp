// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

namespace oort {

/// The version of the map format that this Oort writes; it reads this one and all before it. It goes up by one with
/// every change that an older Oort would misread, and docs/formats.md tells what each changed.
constexpr std::uint32_t kFormatVersion = 1;

/// The original Oort's files, which carry no version.
constexpr std::uint32_t kOriginalFormat = 0;

/// Which format a map file has.
struct MapFormat {
  std::uint32_t version = kOriginalFormat;
  std::string written_by;  ///< the program and its version; empty if the file does not say
};

/// This program and its version, as it signs maps.
const char* writer_name();

/// Throws MapFileError, which names the file and its writer, if the format is newer than kFormatVersion.
void require_known_format(const MapFormat& format, const std::string& file);

}  // namespace oort
