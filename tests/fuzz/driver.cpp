// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Runs a fuzz target without libFuzzer: driver COUNT FILE... tries so many changed copies of the files, the same each
// time. What takes longer than a minute is ended by an alarm.
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                                     std::size_t max_size, unsigned seed);

namespace {
constexpr unsigned kPatience = 60;  // [s]
constexpr std::size_t kMaxSize = 1 << 16;
std::mt19937 generator(1);

std::size_t below(std::size_t count) {
  return generator() % std::max<std::size_t>(count, 1);
}
}  // namespace

/// Changes, copies or cuts out some bytes.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size) {
  if (size == 0 || below(8) == 0) {
    if (size < max_size) data[size++] = static_cast<std::uint8_t>(generator());
    return size;
  }
  const std::size_t at = below(size), from = below(size), length = 1 + below(std::min<std::size_t>(16, size - at));
  switch (below(4)) {
    case 0:
      data[at] = static_cast<std::uint8_t>(data[at] ^ (1U << below(8)));
      return size;
    case 1:
      data[at] = static_cast<std::uint8_t>(generator());
      return size;
    case 2:
      std::copy_n(std::vector<std::uint8_t>(data + from, data + std::min(size, from + length)).begin(),
                  std::min(length, size - std::max(at, from)), data + at);
      return size;
    default:
      std::copy(data + at + length, data + size, data + at);
      return size - length;
  }
}

int main(int argc, char** argv) {
  std::vector<std::vector<std::uint8_t>> corpus;
  for (int k = 2; k < argc; ++k) {
    std::ifstream file(argv[k], std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    LLVMFuzzerTestOneInput(corpus.back().data(), corpus.back().size());
  }
  if (argc < 3) return 2;
  for (int k = 0; k < std::atoi(argv[1]); ++k) {
    std::vector<std::uint8_t> data = corpus[below(corpus.size())];
    std::size_t size = data.size();
    data.resize(std::max(kMaxSize, size));
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
      size = LLVMFuzzerCustomMutator != nullptr
                 ? LLVMFuzzerCustomMutator(data.data(), size, data.size(), static_cast<unsigned>(generator()))
                 : LLVMFuzzerMutate(data.data(), size, data.size());
    }
    if (std::FILE* last = std::getenv("OORT_FUZZ_LAST") ? std::fopen(std::getenv("OORT_FUZZ_LAST"), "wb") : nullptr) {
      std::fwrite(data.data(), 1, size, last);  // to find out what a crash was of
      std::fclose(last);
    }
    ::alarm(kPatience);
    LLVMFuzzerTestOneInput(data.data(), size);
  }
  return 0;
}
