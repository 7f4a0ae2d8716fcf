// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Files of parameters, and the checksum files of maps.
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "oort/geometry/errors.hpp"
#include "oort/parameters/parameter_file.hpp"
#include "oort/parameters/table.hpp"
#include "oort/storage/internal/checksum_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path = std::string(std::tmpnam(nullptr)) + ".json";
  const std::string text(reinterpret_cast<const char*>(data), size);
  oort::parse_checksums(text);
  if (std::FILE* file = std::fopen(path.c_str(), "wb")) {
    std::fwrite(data, 1, size, file);
    std::fclose(file);
  }
  try {
    std::vector<std::string> notes;
    oort::check_parameters(oort::read_parameters(path, &notes));
  } catch (const oort::ParameterError&) {
  }
  return 0;
}
