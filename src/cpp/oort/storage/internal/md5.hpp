// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace oort {

/// The MD5 digest (RFC 1321) of some bytes as 32 lower-case hexadecimal digits. Map files carry it against accidental
/// damage; it protects from nothing else.
std::string md5_hex(std::string_view bytes);

}  // namespace oort
