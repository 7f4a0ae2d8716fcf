// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/storage/map_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "oort/geometry/errors.hpp"
#include "oort/map/map_check.hpp"
#include "oort/storage/internal/codec.hpp"
#include "oort/storage/internal/file_set.hpp"
#include "oort/storage/paths.hpp"

namespace oort {
namespace {

void require_sound(const Map& map, const std::string& base) {
  if (const auto defect = find_defect(map)) {
    throw MapFileError(base + ": the map is not saved because " + *defect + "; correct that first");
  }
}

/// A file X.capnp that holds a map by itself.
bool is_single_file(const std::string& path, const std::string& base) {
  std::error_code ignored;
  return !map_exists(base) && std::filesystem::is_regular_file(path, ignored);
}

SetContent read_single_file(const std::string& path, const LoadOptions& options) {
  if (!options.ignore_checksum) {
    throw MapFileError(path + " has no checksum file beside it; if you trust it, " + kLoadUnchecked);
  }
  const std::filesystem::path absolute = std::filesystem::absolute(path);
  return {
      Directory(absolute.parent_path().string(), Directory::Use::kRead).read(absolute.filename().string()).value_or(""),
      std::nullopt};
}

SetContent read_set(FileSet& files, const LoadOptions& options) {
  try {
    return files.read();
  } catch (const MapFileError&) {
    if (!options.ignore_checksum) throw;
    return files.read_unverified();
  }
}

Map decode(const SetContent& content, const std::string& map_path, const std::string& metadata_path) {
  Map map = decode_map(content.map, map_path);
  if (content.metadata) map.locations = decode_metadata(*content.metadata, metadata_path);
  if (const auto defect = find_defect(map)) {
    throw MapFileError(map_path + " cannot be used because " + *defect + "; restore the map from a copy");
  }
  return map;
}

bool is_same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

bool is_same(const PointCloud& a, const PointCloud& b) {
  return a.time == b.time &&
         std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                    [](const Point2& p, const Point2& q) { return is_same(p.x, q.x) && is_same(p.y, q.y); });
}

/// Whether the locations can be read together with the map as it is on the disk: the nodes that they need are there,
/// and are the same nodes, which they are not if another map lies there, or the map before it was pruned.
bool fits_on_disk(FileSet& files, const Map& map) {
  try {
    const Map there = decode_map(files.read().map, files.map_path());
    return std::all_of(map.locations.begin(), map.locations.end(), [&](const Location& location) {
      return location.node_id < there.clouds.size() &&
             is_same(there.clouds[location.node_id], map.clouds[location.node_id]);
    });
  } catch (const MapFileError&) {
    return false;
  }
}

}  // namespace

Map load_map(const std::string& path, const LoadOptions& options) {
  const std::string base = normalise_map_path(path);
  if (is_single_file(path, base)) return decode(read_single_file(path, options), path, path);
  FileSet files(base, Directory::Use::kRead);
  return decode(read_set(files, options), files.map_path(), files.metadata_path());
}

MapFormat read_map_format(const std::string& path, const LoadOptions& options) {
  const std::string base = normalise_map_path(path);
  if (is_single_file(path, base)) return decode_format(read_single_file(path, options).map, path);
  FileSet files(base, Directory::Use::kRead);
  return decode_format(read_set(files, options).map, files.map_path());
}

void save_map(const std::string& path, const Map& map, const SaveOptions& options) {
  const std::string base = normalise_map_path(path);
  require_sound(map, base);
  const std::string content = encode_map(map, options.as_original);
  const std::string metadata = encode_metadata(map.locations, options.as_original);
  FileSet(base).write(content, metadata);  // the folder is locked no longer than it takes to write
}

Saved save_metadata(const std::string& path, const Map& map) {
  const std::string base = normalise_map_path(path);
  require_sound(map, base);
  FileSet files(base);
  const bool fits = fits_on_disk(files, map);
  files.write(fits ? std::nullopt : std::optional<std::string>(encode_map(map)), encode_metadata(map.locations));
  return fits ? Saved::kMetadata : Saved::kMap;
}

}  // namespace oort
