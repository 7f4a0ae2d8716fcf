# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What comes from outside: files, and the texts and numbers in them, which may be anything."""

import math
import stat
from collections.abc import Iterator
from pathlib import Path

from oort.errors import InputError

_LONGEST = 1 << 30  # [bytes] of a text file: a trajectory of ten million poses
_LARGEST = 1e100  # of a number: squares of larger ones are no numbers any more
_QUOTED = 200  # characters of a damaged line that a message tells of


def check_regular(path: Path, what: str = "") -> None:
    """Raises InputError for what is not read as a file is: it may have no end, be read but once, or never come.

    The message calls it ``what``, if not by its path.
    """
    what = what or str(path)
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"{what} cannot be read: {why}; check the path") from None
    if not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):
        raise InputError(f"{what} is a pipe or a device; write what comes from it into a file, and give that")


def read_text(path: Path) -> str:
    """The text of a file. Raises InputError if it is missing, unreadable, endless or not text."""
    check_regular(path)
    try:
        if path.stat().st_size > _LONGEST:
            raise InputError(f"{path} is larger than {_LONGEST >> 20} MB, which no file of this kind is")
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}; check the path") from None
    except UnicodeDecodeError:
        raise InputError(f"{path} is not a text file") from None


def quoted(value: object) -> str:
    """A value from outside as a message tells of it: not at any length."""
    text = repr(value)
    return text if len(text) <= _QUOTED else f"{text[:_QUOTED]}..."


def plain_number(field: str) -> float:
    """A number as files have it. Raises ValueError for what only Python takes for one, such as 1_0."""
    if "_" in field:
        raise ValueError(f"could not convert string to float: {quoted(field)}")
    return float(field)


def floats(fields: list[str], where: str) -> list[float]:
    """Finite numbers from the fields of a text line. Raises InputError, naming the place, for anything else."""
    try:
        values = [plain_number(field) for field in fields]
    except ValueError:
        values = [math.nan]
    if not all(abs(value) < _LARGEST for value in values):
        raise InputError(f"{where}: expected finite numbers, not {quoted(' '.join(fields))}; the file is damaged")
    return values


def read_rows(path: Path, columns: str) -> Iterator[tuple[str, list[str], list[float]]]:
    """The lines of a text file of numbers: where each is, for messages, its fields, and their values.

    `columns` names the fields, apart by blanks. Empty lines and those that begin with # are left out. Raises
    InputError for a file that cannot be read and for a line of another count or that is not numbers.
    """
    for number, line in enumerate(read_text(path).splitlines(), 1):
        fields = line.split()
        if not fields or fields[0].startswith("#"):
            continue
        where = f"{path}: line {number}"
        if len(fields) != len(columns.split()):
            raise InputError(f"{where}: expected {columns}, but there are {len(fields)} fields")
        yield where, fields, floats(fields, where)
