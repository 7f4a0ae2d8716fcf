// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>

namespace oort {

/// A folder in which files are replaced safely. While the object lives, it holds an advisory lock on the folder, so
/// that programs which save to and load from it take turns. Names are relative to the folder. Errors are MapFileErrors.
class Directory {
 public:
  /// `after_step` is called after each change on the disk; tests use it to stop in between.
  explicit Directory(const std::string& path, std::function<void()> after_step = {});
  ~Directory();
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;

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
