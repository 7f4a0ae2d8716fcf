// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "oort/storage/tuning.hpp"

namespace oort {

/// A folder in which files are replaced safely. While the object lives, it holds an advisory lock on the folder: one
/// program at a time saves to it, and meanwhile none loads. Names are relative to the folder. Errors are MapFileErrors.
class Directory {
 public:
  enum class Use { kRead, kWrite };

  /// `after_step` is called after each change on the disk; tests use it to stop in between. Throws MapFileError if
  /// there is no such folder, or if the lock of another program stays for longer than `patience`.
  explicit Directory(const std::string& path, Use use, std::function<void()> after_step = {},
                     std::chrono::milliseconds patience = StorageTuning::kLockPatience);
  ~Directory();
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;

  /// Makes a lock for reading one for writing, if no other program has one; others may have written before that.
  bool try_to_lock_for_writing();

  bool holds(const std::string& name) const;

  /// The content of a file; nothing if there is none.
  std::optional<std::string> read(const std::string& name) const;

  /// Makes or overwrites a file and waits until it is on the disk.
  void write(const std::string& name, const std::string& content);

  /// Gives a file a new name; a file that has that name is replaced.
  void rename(const std::string& from, const std::string& to);

  /// Deletes a file if it is there; a failure is not reported.
  void remove(const std::string& name) noexcept;

  /// Waits until the folder's own entries are on the disk.
  void sync();

  /// The path of a file of this folder, for messages.
  std::string path_of(const std::string& name) const { return path_ + "/" + name; }

 private:
  void step() const {
    if (after_step_) after_step_();
  }

  std::string path_;
  std::function<void()> after_step_;
  int fd_;
};

}  // namespace oort
