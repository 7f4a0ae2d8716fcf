// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// A layer of file calls for LD_PRELOAD, whose n-th call can be made to fail. tests/py/helpers/faulty_files.py builds it.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

static atomic_int armed, left, error_number, is_short, forever;
static char folder[4096];

/// From now on, of calls that change files below a folder, the one after `calls` others fails with an error; with
/// `errors` 0 it is a write that writes half. With `on` all after it fail, too.
void faulty_files_arm(const char* below, int calls, int error, int on) {
  snprintf(folder, sizeof folder, "%s", below);
  left = calls;
  error_number = error;
  is_short = error == 0;
  forever = on;
  armed = 1;
}

/// Whether the failure came; no call fails any more.
int faulty_files_disarm(void) {
  armed = 0;
  return left < 0;
}

static int below(int fd) {
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length < 0) return 0;
  path[length] = 0;
  return strncmp(path, folder, strlen(folder)) == 0;
}

/// Whether this call is to fail.
static int fails(int concerns) {
  if (!armed || !concerns) return 0;
  const int before = atomic_fetch_sub(&left, 1);
  if (before > 0 || (before < 0 && !forever)) return 0;
  errno = error_number;
  return 1;
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int fd, const void* data, size_t size) {
  if (fails(armed && below(fd))) {
    if (!is_short || size < 2) return is_short ? 0 : -1;
    return NEXT(write)(fd, data, size / 2);
  }
  return NEXT(write)(fd, data, size);
}

int fsync(int fd) {
  return fails(armed && !is_short && below(fd)) ? -1 : NEXT(fsync)(fd);
}

int close(int fd) {
  const int failed = fails(armed && !is_short && below(fd));
  const int error = errno;
  const int result = NEXT(close)(fd);
  errno = failed ? error : errno;
  return failed ? -1 : result;
}

int renameat(int from_fd, const char* from, int to_fd, const char* to) {
  return fails(armed && !is_short && below(to_fd)) ? -1 : NEXT(renameat)(from_fd, from, to_fd, to);
}

int openat(int fd, const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;
  va_end(more);
  const int writes = (flags & O_ACCMODE) != O_RDONLY;
  if (fails(armed && !is_short && writes && fd >= 0 && below(fd))) return -1;
  return NEXT(openat)(fd, path, flags, mode);
}
