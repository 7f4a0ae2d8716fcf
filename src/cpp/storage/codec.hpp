// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "oort/mapping/map.hpp"

namespace oort {

/// A map's graph and sidecar as the bytes of a .map_capnp file: a packed Cap'n Proto message with the root Map2d.
/// The same map gives the same bytes, and a map that the original wrote gives the original's.
/// Throws MapFileError if the map is too large for the format.
std::string encode_map(const Map& map);

/// Locations as the bytes of a .map_meta_capnp file: a packed Cap'n Proto message with the root Map2dMetadata.
std::string encode_metadata(const std::vector<Location>& locations);

/// The inverse of encode_map(); the result has no locations. Throws MapFileError, which names `file`, for bytes that
/// are damaged, not packed, or of another root. Whether the content makes sense is find_defect()'s to say.
Map decode_map(const std::string& bytes, const std::string& file);

/// The inverse of encode_metadata(), with the same errors.
std::vector<Location> decode_metadata(const std::string& bytes, const std::string& file);

}  // namespace oort
