// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/storage/paths.hpp"

#include <filesystem>
#include <string_view>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {
namespace fs = std::filesystem;

bool ends_with(std::string_view text, std::string_view suffix) {
  return text.size() > suffix.size() && text.substr(text.size() - suffix.size()) == suffix;
}

std::string without(const std::string& text, std::string_view suffix) {
  return ends_with(text, suffix) ? text.substr(0, text.size() - suffix.size()) : text;
}

/// Follows links of the folder, and of the base or its map file, which may point to another name. `hops` ends a circle.
std::string follow_links(const std::string& base, int hops) {
  const fs::path path = base;
  std::string here = (fs::weakly_canonical(path.parent_path()) / path.filename()).string();
  if (hops == 0) return here;
  for (const std::string suffix : {kMapSuffix, ""}) {
    const std::string link = here + suffix;
    if (!fs::is_symlink(link)) continue;
    const std::string target = (fs::path(link).parent_path() / fs::read_symlink(link)).string();
    // A link to a file of some other name (a content-addressed store) says nothing about the map's base path.
    if (suffix.empty() || ends_with(target, suffix)) return follow_links(without(target, suffix), hops - 1);
  }
  return here;
}

std::string resolve(const std::string& path) {
  constexpr int kMaxHops = 16;
  const std::string absolute = fs::absolute(path).string();
  std::string base = without(without(absolute, kMapSuffix), kMetadataSuffix);
  if (fs::path(base).filename().empty() || fs::is_directory(absolute)) {
    throw MapFileError("map path '" + path + "' names a directory; add the map's name, as in /home/robot/maps/home");
  }
  base = follow_links(base, kMaxHops);
  if (!ends_with(base, ".capnp") || map_exists(base)) return base;
  return follow_links(without(base, ".capnp"), kMaxHops);
}

}  // namespace

std::string normalise_map_path(const std::string& path) {
  if (path.empty()) throw MapFileError("the map's path is empty; give the path of a map, as in /home/robot/maps/home");
  if (path.find('\0') != std::string::npos) {
    throw MapFileError("the map's path holds a NUL character, which no path can; take it out");
  }
  try {
    return resolve(path);
  } catch (const fs::filesystem_error& error) {
    throw MapFileError("map path '" + path + "' cannot be followed: " + error.code().message() +
                       "; check its folders and their permissions");
  }
}

bool map_exists(const std::string& base) {
  std::error_code ignored;
  for (const std::string suffix : {kMapSuffix, kMetadataSuffix, kChecksumSuffix}) {
    if (fs::exists(base + suffix, ignored) || fs::exists(base + suffix + kNewSuffix, ignored)) return true;
  }
  return false;
}

}  // namespace oort
