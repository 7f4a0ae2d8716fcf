// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/storage/internal/md5.hpp"

#include <array>
#include <cmath>
#include <cstdint>

namespace oort {
namespace {

using State = std::array<std::uint32_t, 4>;

/// T[i] of RFC 1321, section 3.4: the whole part of 2^32 |sin(i + 1)|.
std::array<std::uint32_t, 64> make_sines() {
  std::array<std::uint32_t, 64> sines{};
  for (std::size_t i = 0; i < sines.size(); ++i) {
    sines[i] = static_cast<std::uint32_t>(4294967296.0 * std::abs(std::sin(static_cast<double>(i + 1))));
  }
  return sines;
}
const std::array<std::uint32_t, 64> kSines = make_sines();

constexpr int kShifts[4][4] = {{7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}};
constexpr std::size_t kFactor[4] = {1, 5, 3, 7};  // round r takes word (factor * i + offset) mod 16 in step i
constexpr std::size_t kOffset[4] = {0, 1, 5, 0};

std::uint32_t mix(std::size_t round, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  switch (round) {
    case 0:
      return (x & y) | (~x & z);
    case 1:
      return (x & z) | (y & ~z);
    case 2:
      return x ^ y ^ z;
    default:
      return y ^ (x | ~z);
  }
}

void add_block(const unsigned char* block, State& state) {
  std::array<std::uint32_t, 16> words{};
  for (std::size_t i = 0; i < 64; ++i) words[i / 4] |= static_cast<std::uint32_t>(block[i]) << (8 * (i % 4));
  auto [a, b, c, d] = state;
  for (std::size_t i = 0; i < 64; ++i) {
    const std::size_t round = i / 16;
    const std::uint32_t sum = a + mix(round, b, c, d) + words[(kFactor[round] * i + kOffset[round]) % 16] + kSines[i];
    const int shift = kShifts[round][i % 4];
    a = d;
    d = c;
    c = b;
    b += (sum << shift) | (sum >> (32 - shift));
  }
  state[0] += a;
  state[1] += b;
  state[2] += c;
  state[3] += d;
}

}  // namespace

std::string md5_hex(std::string_view bytes) {
  State state = {0x67452301U, 0xefcdab89U, 0x98badcfeU, 0x10325476U};
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  const std::size_t whole = bytes.size() / 64 * 64;
  for (std::size_t i = 0; i < whole; i += 64) add_block(data + i, state);

  // The rest, then 0x80, zeros up to 56 modulo 64, and the length in bits as 8 bytes, least first.
  std::string tail(bytes.substr(whole));
  tail.push_back('\x80');
  while (tail.size() % 64 != 56) tail.push_back('\0');
  const std::uint64_t bits = static_cast<std::uint64_t>(bytes.size()) * 8U;
  for (int i = 0; i < 8; ++i) tail.push_back(static_cast<char>((bits >> (8 * i)) & 0xffU));
  for (std::size_t i = 0; i < tail.size(); i += 64) {
    add_block(reinterpret_cast<const unsigned char*>(tail.data()) + i, state);
  }

  std::string hex;
  for (std::size_t i = 0; i < 16; ++i) {
    const std::uint32_t byte = (state[i / 4] >> (8 * (i % 4))) & 0xffU;
    hex += "0123456789abcdef"[byte >> 4U];
    hex += "0123456789abcdef"[byte & 0xfU];
  }
  return hex;
}

}  // namespace oort
