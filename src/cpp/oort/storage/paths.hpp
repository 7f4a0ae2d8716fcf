// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace oort {

/// The three files of a map with base path B: B.map_capnp (graph and clouds), B.map_meta_capnp (locations) and B.md5
/// (the checksums of both).
constexpr const char* kMapSuffix = ".map_capnp";
constexpr const char* kMetadataSuffix = ".map_meta_capnp";
constexpr const char* kChecksumSuffix = ".md5";
/// Follows the name of each file while a new set is being written beside the old one.
constexpr const char* kNewSuffix = ".new";

/// The absolute base path B of a map that is given as B, B.map_capnp, B.map_meta_capnp or X.capnp.
///
/// X.capnp, the form of the original's manual, means the base X, unless there is a map with the base X.capnp itself.
/// Symbolic links are followed, those to B's files too, so that a link to a map's .map_capnp names that map.
/// The map need not exist. Throws MapFileError if the path is empty or names a directory.
std::string normalise_map_path(const std::string& path);

/// Whether some file of a map lies at a base path, finished or not.
bool map_exists(const std::string& base);

}  // namespace oort
