# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Which session saves to a map's path: one at a time, or the last save of two would be all that stays."""

import contextlib
import fcntl
import os
from pathlib import Path

from oort._core import normalise_map_path
from oort.errors import MapFileError


class Claim:
    """Holds a map's path for as long as this process lives, by a lock on the file ``.NAME.lock`` beside the map.

    A file that was left behind by a process that died holds nothing. In a file system without locks nothing is claimed.
    """

    def __init__(self, path: str) -> None:
        """Claims a path. Raises MapFileError if another session has it."""
        base = Path(normalise_map_path(path))
        self._base = str(base)
        self._file = base.with_name(f".{base.name}.lock")
        while True:
            self._number = _open(self._file)
            self._lock()
            if _is_at(self._number, self._file):
                break
            os.close(self._number)  # its owner ended, and removed it, in between
        with contextlib.suppress(OSError):
            os.ftruncate(self._number, 0)
            os.pwrite(self._number, f"{os.getpid()}\n".encode(), 0)

    def _lock(self) -> None:
        try:
            fcntl.flock(self._number, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            owner = os.pread(self._number, 100, 0).decode("ascii", errors="replace").strip()
            os.close(self._number)
            raise MapFileError(
                f"{self._base}: another session saves its map there"
                f"{f' (process {owner})' if owner.isdecimal() else ''}; end that one, or give another path"
            ) from None
        except OSError:
            pass  # a file system without locks

    def is_for(self, path: str) -> bool:
        """Whether that is what it claims."""
        return normalise_map_path(path) == self._base

    def release(self) -> None:
        """Gives the path up."""
        with contextlib.suppress(OSError):
            os.unlink(self._file)  # while it is locked: who has opened it meanwhile finds that it is gone
        os.close(self._number)


def _open(path: Path) -> int:
    try:
        return os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK, 0o666)
    except OSError as error:
        raise MapFileError(f"{path} cannot be made: {error.strerror}; check the folder's permissions") from None


def _is_at(number: int, path: Path) -> bool:
    """Whether an open file is the one at a path."""
    try:
        return os.path.samestat(os.fstat(number), path.stat())
    except FileNotFoundError:
        return False
