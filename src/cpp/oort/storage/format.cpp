// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/storage/format.hpp"

#include "oort/geometry/errors.hpp"

namespace oort {

const char* writer_name() {
  return "Oort " OORT_VERSION;
}

void require_known_format(const MapFormat& format, const std::string& file) {
  if (format.version <= kFormatVersion) return;
  const std::string writer = format.written_by.empty() ? "a newer Oort" : format.written_by;
  throw MapFileError(file + " has the map format " + std::to_string(format.version) + ", written by " + writer +
                     "; this is " + writer_name() + ", which reads formats up to " + std::to_string(kFormatVersion) +
                     ": update it, or load the map with the program that wrote it");
}

}  // namespace oort
