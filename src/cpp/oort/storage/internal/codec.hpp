// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "oort/map/map.hpp"
#include "oort/storage/format.hpp"

namespace oort {

/// A map's graph and sidecar as the bytes of a .map_capnp file: a packed Cap'n Proto message with the root Map2d.
/// The same map gives the same bytes; as_original, a map that the original wrote gives the original's.
/// Throws MapFileError if the map is too large for the format.
std::string encode_map(const Map& map, bool as_original = false);

/// Locations as the bytes of a .map_meta_capnp file: a packed Cap'n Proto message with the root Map2dMetadata.
std::string encode_metadata(const std::vector<Location>& locations, bool as_original = false);

/// The inverse of encode_map(); the result has no locations. Throws MapFileError, which names `file`, for bytes that
/// are damaged, not packed, of another root, or in a newer format than this Oort knows. Whether the content makes sense
/// is find_defect()'s to say.
Map decode_map(const std::string& bytes, const std::string& file);

/// The inverse of encode_metadata(), with the same errors.
std::vector<Location> decode_metadata(const std::string& bytes, const std::string& file);

/// What the bytes of a .map_capnp file say of their format, known or not. Errors as decode_map().
MapFormat decode_format(const std::string& bytes, const std::string& file);

}  // namespace oort
