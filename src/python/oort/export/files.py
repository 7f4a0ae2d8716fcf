# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What all exports share: files that are whole at every instant, and numbers that read back to the same bits."""

import math
import os
import threading
from pathlib import Path

import numpy as np

from oort.errors import InputError, OortError


def write_atomically(path: Path, data: bytes) -> None:
    """Writes a file so that at every instant it is the old one or the new one. Raises OortError if it cannot."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}.{threading.get_ident()}.tmp")
    try:
        try:
            with temporary.open("wb") as stream:
                stream.write(data)
                stream.flush()
                os.fsync(stream.fileno())
            os.replace(temporary, path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise
        directory = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(directory)  # the new name, too, must outlive a power cut
        finally:
            os.close(directory)
    except OSError as error:
        raise OortError(f"{path} cannot be written: {error.strerror}; check the directory and the free space") from None


def read_text(path: Path) -> str:
    """The text of a file. Raises InputError if it is missing, unreadable or not text."""
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}; check the path") from None
    except UnicodeDecodeError:
        raise InputError(f"{path} is not a text file") from None


def decimal(value: float) -> str:
    """The shortest decimal, without an exponent, that reads back to the same number.

    Without an exponent, because YAML 1.1 takes "1e-05" for a text. Raises InputError for nan and infinity.
    """
    if not math.isfinite(value):
        raise InputError(f"{value} cannot be exported: every number must be finite")
    return np.format_float_positional(float(value) + 0.0, unique=True, trim="0")  # + 0.0 makes -0.0 plain


def floats(fields: list[str], where: str) -> list[float]:
    """Finite numbers from the fields of a text line. Raises InputError, naming the place, for anything else."""
    try:
        values = [float(field) for field in fields]
    except ValueError:
        values = [math.nan]
    if not all(map(math.isfinite, values)):
        raise InputError(f"{where}: expected finite numbers, not {' '.join(fields)!r}; the file is damaged")
    return values
