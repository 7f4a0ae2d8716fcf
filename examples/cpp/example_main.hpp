// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// What the examples' main functions share: two arguments, and errors told as sentences.
#pragma once
#include <cstdio>
#include <oort/oort.hpp>
#include <string>

inline int example_main(int argc, char** argv,
                        void (*example)(const std::string& log_path, const std::string& map_path)) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s LOG MAP\n", argv[0]);
    return 2;
  }
  try {
    example(argv[1], argv[2]);
  } catch (const oort::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
