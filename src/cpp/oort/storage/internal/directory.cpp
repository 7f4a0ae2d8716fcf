// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/storage/internal/directory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <thread>

#include "oort/geometry/errors.hpp"
#include "oort/storage/tuning.hpp"

namespace oort {
namespace {

/// The error for a failed call of the operating system; to be made before errno changes.
MapFileError failed(const std::string& what, const std::string& path, const std::string& advice) {
  return MapFileError(path + ": cannot " + what + ": " + std::strerror(errno) + "; " + advice);
}

/// Closes a file however its block is left.
class File {
 public:
  explicit File(int fd) : fd_(fd) {}
  ~File() {
    if (fd_ >= 0) ::close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  int fd() const { return fd_; }

  /// Closes it and says whether that worked: some file systems report a full disk only now.
  bool close() {
    const int fd = fd_;
    fd_ = -1;
    return ::close(fd) == 0;
  }

 private:
  int fd_;
};

bool write_all(int fd, const std::string& content) {
  std::size_t done = 0;
  for (int retries = 0; done < content.size();) {
    const ssize_t count = ::write(fd, content.data() + done, content.size() - done);
    if (count > 0) {
      done += static_cast<std::size_t>(count);
      retries = 0;
    } else if ((count < 0 && errno != EINTR) || ++retries > StorageTuning::kMaxRetries) {
      if (count == 0) errno = EIO;
      return false;
    }
  }
  return true;
}

bool read_all(int fd, std::size_t size, std::string& content) {
  content.resize(size);
  std::size_t done = 0;
  for (int retries = 0; done < size;) {
    const ssize_t count = ::read(fd, content.data() + done, size - done);
    if (count == 0) break;  // it became shorter; the checksum will tell
    if (count > 0) {
      done += static_cast<std::size_t>(count);
      retries = 0;
    } else if (errno != EINTR || ++retries > StorageTuning::kMaxRetries) {
      return false;
    }
  }
  content.resize(done);
  return true;
}

}  // namespace

/// Whether that was possible; in a file system without locks, where one program at a time must see to it itself, too.
bool try_lock(int fd, int kind) {
  return ::flock(fd, kind | LOCK_NB) == 0 || (errno != EWOULDBLOCK && errno != EINTR);
}

Directory::Directory(const std::string& path, Use use, std::function<void()> after_step,
                     std::chrono::milliseconds patience)
    : path_(path), after_step_(std::move(after_step)), fd_(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (fd_ < 0) throw failed("open the folder", path, "make it, or check its permissions");
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!try_lock(fd_, use == Use::kWrite ? LOCK_EX : LOCK_SH)) {
    if (std::chrono::steady_clock::now() >= deadline) {
      ::close(fd_);
      throw MapFileError(path + ": another program holds a lock on this folder and did not give it up for " +
                         std::to_string(patience.count() / 1000) +
                         " s; end that program ('fuser -v' on the folder names it), or try again");
    }
    std::this_thread::sleep_for(std::min(StorageTuning::kLockLook, patience));
  }
}

bool Directory::try_to_lock_for_writing() {
  return try_lock(fd_, LOCK_EX);
}

Directory::~Directory() {
  ::close(fd_);
}

bool Directory::holds(const std::string& name) const {
  return ::faccessat(fd_, name.c_str(), F_OK, 0) == 0;
}

std::optional<std::string> Directory::read(const std::string& name) const {
  // O_NONBLOCK: what is not a regular file must not make us wait.
  const File file(::openat(fd_, name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.fd() < 0) {
    if (errno == ENOENT) return std::nullopt;
    throw failed("read it", path_of(name), "check its permissions");
  }
  struct stat status {};
  if (::fstat(file.fd(), &status) != 0) throw failed("read it", path_of(name), "check the disk");
  if (!S_ISREG(status.st_mode)) throw MapFileError(path_of(name) + " is not a file; move it away");
  if (static_cast<std::uint64_t>(status.st_size) > StorageTuning::kMaxFileSize) {
    throw MapFileError(path_of(name) + " is of " + std::to_string(status.st_size) + " bytes, which is no map's size");
  }
  std::string content;
  if (!read_all(file.fd(), static_cast<std::size_t>(status.st_size), content)) {
    throw failed("read it", path_of(name), "check the disk");
  }
  return content;
}

void Directory::write(const std::string& name, const std::string& content) {
  File file(::openat(fd_, name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (file.fd() < 0) throw failed("make it", path_of(name), "check the folder's permissions and the disk");
  step();
  if (!write_all(file.fd(), content) || ::fsync(file.fd()) != 0 || !file.close()) {
    throw failed("write it", path_of(name), "make room on the disk; what was saved before is still whole");
  }
  step();
}

void Directory::rename(const std::string& from, const std::string& to) {
  if (::renameat(fd_, from.c_str(), fd_, to.c_str()) != 0) {
    throw failed("rename it to " + to, path_of(from), "check the folder's permissions; loading the map completes it");
  }
  step();
}

void Directory::remove(const std::string& name) noexcept {
  ::unlinkat(fd_, name.c_str(), 0);
}

void Directory::sync() {
  // Some file systems cannot synchronise a folder and say EINVAL: there is nothing more to be done there.
  if (::fsync(fd_) != 0 && errno != EINVAL) throw failed("synchronise the folder", path_, "check the disk");
}

}  // namespace oort
