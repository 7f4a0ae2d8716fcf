# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What all exports share: files that are whole at every instant, and numbers that read back to the same bits."""

import math
import os
import tempfile
from contextlib import suppress
from pathlib import Path

import numpy as np

from oort.errors import InputError, OortError


def make_folder(path: Path) -> None:
    """Makes the folder that results go into, and tries whether files can be: before the work rather than after it.

    Raises OortError if not.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            pass
    except FileExistsError:
        raise OortError(f"{path} is no folder; choose another path") from None
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        why = error.strerror if isinstance(error, OSError) else error
        raise OortError(f"nothing can be written into {path}: {why}; check who may write there") from None


def write_atomically(path: Path, data: bytes) -> None:
    """Writes a file so that at every instant it is the old one or the new one. Raises OortError if it cannot.

    What a link points to is written. A device or a pipe stays what it is, and is written to.
    """
    try:
        if path.exists() and not path.is_file() and not path.is_dir():
            _write_through(path, data)
        else:
            _replace(Path(os.path.realpath(path)), data)
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        why = error.strerror if isinstance(error, OSError) else error
        raise OortError(f"{path} cannot be written: {why}; check the directory and the free space") from None


def _replace(path: Path, data: bytes) -> None:
    number, temporary = tempfile.mkstemp(prefix=f".{path.name[:64]}.", suffix=".tmp", dir=path.parent)
    try:
        with open(number, "wb") as stream:
            os.fchmod(stream.fileno(), path.stat().st_mode & 0o777 if path.exists() else 0o666 & ~_umask())
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(temporary, path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
    directory = os.open(path.parent, os.O_RDONLY)
    try:
        os.fsync(directory)  # the new name, too, must outlive a power cut
    finally:
        os.close(directory)


def _write_through(path: Path, data: bytes) -> None:
    number = os.open(path, os.O_WRONLY | os.O_NONBLOCK)  # a pipe that nobody reads is an error
    os.set_blocking(number, True)
    with open(number, "wb") as stream:
        stream.write(data)


def _umask() -> int:
    """As the kernel tells it: to ask by os.umask() would set it for a moment, for other threads, too."""
    with suppress(OSError), open("/proc/self/status", encoding="ascii", errors="replace") as status:
        for line in status:
            if line.startswith("Umask:"):
                return int(line.split()[1], 8)
    return 0o022


def decimal(value: float) -> str:
    """The shortest decimal, without an exponent, that reads back to the same number.

    Without an exponent, because YAML 1.1 takes "1e-05" for a text. Raises InputError for nan and infinity.
    """
    if not math.isfinite(value):
        raise InputError(f"{value} cannot be exported: every number must be finite")
    return np.format_float_positional(float(value) + 0.0, unique=True, trim="0")  # + 0.0 makes -0.0 plain
