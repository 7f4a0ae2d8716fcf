// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "oort/storage/internal/directory.hpp"

namespace oort {

/// How to recover a map whose checksums are lost or do not fit, in words that follow a condition.
inline constexpr const char* kLoadUnchecked =
    "load it with ignore_checksum (in Python oort.load_map(path, ignore_checksum=True)) and save it anew";

/// The bytes of a map's two content files.
struct SetContent {
  std::string map;
  std::optional<std::string> metadata;  ///< nothing only where read_unverified() finds no such file
};

/// The three files of one map (storage/paths.hpp), which are replaced as one.
///
/// A new set is first written whole under names with the suffix ".new", its checksum file last, and then renamed file
/// by file, the checksum file last. So at every instant a set is whole in the sense that a checksum file fits one of
/// the two files (new or not) of each kind; reading looks for such a set, newest first, and completes the renaming.
class FileSet {
 public:
  /// `base` is the absolute base path. Holds the lock on its folder while it lives; write() needs it for writing.
  /// For `after_step`, `patience` and errors see Directory.
  explicit FileSet(const std::string& base, Directory::Use use = Directory::Use::kWrite,
                   std::function<void()> after_step = {},
                   std::chrono::milliseconds patience = StorageTuning::kLockPatience);

  /// The newest whole set. Throws MapFileError, which says what does not fit, if there is none.
  SetContent read();

  /// The files as they are, whatever their checksums; no metadata if there is no such file.
  /// Throws MapFileError if there is no map file.
  SetContent read_unverified() const;

  /// Replaces the set. Without `map` the map file stays and only metadata and checksums are written; then the set must
  /// be whole. Throws MapFileError if it cannot be written; the old set is then still whole and nothing is left beside
  /// it, unless the error came while renaming: then the new set is whole and the next read() completes it.
  void write(const std::optional<std::string>& map, const std::string& metadata);

  std::string map_path() const { return directory_.path_of(map_name_); }
  std::string metadata_path() const { return directory_.path_of(metadata_name_); }

 private:
  /// A whole set: its content, and for each file whether it is still the one with the suffix ".new".
  struct Whole {
    SetContent content;
    bool map_is_new = false;
    bool metadata_is_new = false;
    bool checksum_is_new = false;
  };

  std::optional<Whole> find_newest();
  std::optional<Whole> find_whole() const;
  std::optional<Whole> find_whole(bool checksum_is_new) const;
  std::string why_not_whole() const;
  void finish_renaming(const Whole& whole);
  void remove_new() noexcept;
  bool holds_new() const;

  std::string map_name_;
  std::string metadata_name_;
  std::string checksum_name_;
  Directory directory_;
  bool may_write_;
};

}  // namespace oort
