// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "oort/map/map.hpp"
#include "oort/storage/format.hpp"

namespace oort {

struct LoadOptions {
  bool ignore_checksum = false;  ///< to recover files whose checksums are lost or do not fit
};

/// Reads a map. `path` is any of the forms that normalise_map_path() knows; with ignore_checksum also a .map_capnp file
/// alone, or a single file X.capnp that holds what a .map_capnp file does. A map whose saving was cut off is completed.
/// Throws MapFileError, which names the file and says what to do, if there is no such map, its checksums do not fit, it
/// cannot be decoded, is in a newer format than this Oort knows, or its content makes no sense (find_defect()).
Map load_map(const std::string& path, const LoadOptions& options = {});

/// In which format a map is, even if it is too new to be loaded. `path`, options and errors as load_map().
MapFormat read_map_format(const std::string& path, const LoadOptions& options = {});

struct SaveOptions {
  bool as_original = false;  ///< without what the published schema has not: a map of the original keeps its bytes
};

/// Writes a map's three files as one: whenever it is interrupted, the old map or the new one is whole on the disk.
/// Throws MapFileError if the map has a defect or cannot be written; the old map is then still there.
void save_map(const std::string& path, const Map& map, const SaveOptions& options = {});

enum class Saved { kMap, kMetadata };

/// Writes a map's locations: the metadata and the checksum file, which is cheap for a large map. Writes the whole map
/// instead if there is no whole map with that path, or its graph lacks a node that a location needs; says which it was.
/// Errors as save_map().
Saved save_metadata(const std::string& path, const Map& map);

}  // namespace oort
