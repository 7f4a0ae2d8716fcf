// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/storage/internal/file_set.hpp"

#include <filesystem>

#include "oort/geometry/errors.hpp"
#include "oort/storage/internal/checksum_file.hpp"
#include "oort/storage/internal/md5.hpp"
#include "oort/storage/paths.hpp"

namespace oort {
namespace {

std::string folder_of(const std::string& base) {
  return std::filesystem::path(base).parent_path().string();
}
std::string name_of(const std::string& base) {
  return std::filesystem::path(base).filename().string();
}

/// Whichever of a file and its ".new" version has a digest, the preferred one first; says which it was.
std::optional<std::string> read_matching(const Directory& directory, const std::string& name, const std::string& digest,
                                         bool prefer_new, bool& is_new) {
  for (const bool candidate : {prefer_new, !prefer_new}) {
    std::optional<std::string> content = directory.read(candidate ? name + kNewSuffix : name);
    if (content && md5_hex(*content) == digest) {
      is_new = candidate;
      return content;
    }
  }
  return std::nullopt;
}

}  // namespace

FileSet::FileSet(const std::string& base, Directory::Use use, std::function<void()> after_step,
                 std::chrono::milliseconds patience)
    : map_name_(name_of(base) + kMapSuffix),
      metadata_name_(name_of(base) + kMetadataSuffix),
      checksum_name_(name_of(base) + kChecksumSuffix),
      directory_(folder_of(base), use, std::move(after_step), patience),
      may_write_(use == Directory::Use::kWrite) {}

SetContent FileSet::read() {
  std::optional<Whole> whole = find_newest();
  const bool is_new = whole && (whole->map_is_new || whole->metadata_is_new || whole->checksum_is_new);
  if (is_new && !may_write_) {
    may_write_ = directory_.try_to_lock_for_writing();
    whole = find_newest();  // another program may have written in between
  }
  if (!whole) throw MapFileError(why_not_whole());
  try {
    if (may_write_) finish_renaming(*whole);
  } catch (const MapFileError&) {
    // A medium that cannot be written: the map can be read as it lies there.
  }
  return std::move(whole->content);
}

SetContent FileSet::read_unverified() const {
  std::optional<std::string> map = directory_.read(map_name_);
  if (!map) throw MapFileError(map_path() + " does not exist; check the map's path");
  return {std::move(*map), directory_.read(metadata_name_)};
}

void FileSet::write(const std::optional<std::string>& map, const std::string& metadata) {
  if (holds_new()) {  // an earlier save was cut off: complete it if it can be, before its files are overwritten
    if (const std::optional<Whole> whole = find_whole()) finish_renaming(*whole);
    remove_new();
  }
  Checksums checksums{"", md5_hex(metadata)};
  if (map) {
    checksums.map = md5_hex(*map);
  } else {
    const std::optional<Whole> whole = find_whole();
    if (!whole) throw MapFileError(why_not_whole());
    checksums.map = md5_hex(whole->content.map);
  }
  try {
    if (map) directory_.write(map_name_ + kNewSuffix, *map);
    directory_.write(metadata_name_ + kNewSuffix, metadata);
    directory_.write(checksum_name_ + kNewSuffix, format_checksums(checksums, map_name_, metadata_name_));
    directory_.sync();
  } catch (const MapFileError&) {
    remove_new();
    throw;
  }
  finish_renaming({{}, map.has_value(), true, true});
}

/// Something odd under the new names must not hide what is under the old ones.
std::optional<FileSet::Whole> FileSet::find_newest() {
  try {
    if (std::optional<Whole> whole = find_whole(true)) return whole;
  } catch (const MapFileError&) {
  }
  return find_whole(false);
}

std::optional<FileSet::Whole> FileSet::find_whole() const {
  std::optional<Whole> whole = find_whole(true);
  return whole ? std::move(whole) : find_whole(false);
}

std::optional<FileSet::Whole> FileSet::find_whole(bool checksum_is_new) const {
  const auto text = directory_.read(checksum_is_new ? checksum_name_ + kNewSuffix : checksum_name_);
  const auto checksums = text ? parse_checksums(*text) : std::nullopt;
  if (!checksums) return std::nullopt;
  Whole whole;
  whole.checksum_is_new = checksum_is_new;
  auto map = read_matching(directory_, map_name_, checksums->map, checksum_is_new, whole.map_is_new);
  if (!map) return std::nullopt;
  auto metadata =
      read_matching(directory_, metadata_name_, checksums->metadata, checksum_is_new, whole.metadata_is_new);
  if (!metadata) return std::nullopt;
  whole.content = {std::move(*map), std::move(*metadata)};
  return whole;
}

std::string FileSet::why_not_whole() const {
  const std::string advice =
      std::string("; restore the map's three files from a copy, or if you trust them ") + kLoadUnchecked;
  for (const std::string& name : {map_name_, metadata_name_, checksum_name_}) {
    if (!directory_.holds(name)) {
      const bool is_map = name == map_name_;
      return directory_.path_of(name) + " does not exist" + (is_map ? "; check the map's path" : advice);
    }
  }
  const auto checksums = parse_checksums(directory_.read(checksum_name_).value_or(""));
  if (!checksums) return directory_.path_of(checksum_name_) + " does not hold the checksums of the map" + advice;
  const bool map_fits = md5_hex(directory_.read(map_name_).value_or("")) == checksums->map;
  return directory_.path_of(map_fits ? metadata_name_ : map_name_) + " does not fit its checksum in " + checksum_name_ +
         ": it was damaged or changed" + advice;
}

void FileSet::finish_renaming(const Whole& whole) {
  if (whole.map_is_new) directory_.rename(map_name_ + kNewSuffix, map_name_);
  if (whole.metadata_is_new) directory_.rename(metadata_name_ + kNewSuffix, metadata_name_);
  if (whole.checksum_is_new) directory_.rename(checksum_name_ + kNewSuffix, checksum_name_);
  if (whole.map_is_new || whole.metadata_is_new || whole.checksum_is_new) directory_.sync();
}

void FileSet::remove_new() noexcept {
  for (const std::string& name : {checksum_name_, metadata_name_, map_name_}) directory_.remove(name + kNewSuffix);
}

bool FileSet::holds_new() const {
  return directory_.holds(map_name_ + kNewSuffix) || directory_.holds(metadata_name_ + kNewSuffix) ||
         directory_.holds(checksum_name_ + kNewSuffix);
}

}  // namespace oort
