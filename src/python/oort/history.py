# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Earlier versions of a map, kept beside it as maps of their own: BASE.previous, the latest, BASE.previous.2, ..."""

import time
from dataclasses import dataclass
from pathlib import Path

from oort._core import load_map, normalise_map_path, save_map
from oort.errors import InputError, MapFileError

VERSIONS = 3  # that are kept
_FILES = (".map_capnp", ".map_meta_capnp", ".md5")


@dataclass(frozen=True, slots=True)
class Version:
    """An earlier version of a map."""

    number: int
    """counts back from the latest, 1"""
    path: str
    saved: float
    """[s] since 1970; when the version was kept"""


def keep_version(path: str) -> str:
    """Copies the map that is saved at a path to its latest version; where that is. The oldest version goes.

    Each step leaves whole maps behind, wherever it is interrupted. Raises MapFileError if the map cannot be read or the
    copy cannot be written; a version that cannot be read any more is left where it is until its turn to go comes.
    """
    base = normalise_map_path(path)
    map_ = load_map(base)
    for number in range(VERSIONS, 1, -1):
        try:
            older = load_map(_path_of(base, number - 1))
        except MapFileError:
            continue
        save_map(_path_of(base, number), older)
    save_map(_path_of(base, 1), map_)
    return _path_of(base, 1)


def versions(path: str) -> list[Version]:
    """The earlier versions of the map at a path, the latest first."""
    base = normalise_map_path(path)
    paths = [(number, _path_of(base, number)) for number in range(1, VERSIONS + 1)]
    there = [(number, path, Path(path + _FILES[0])) for number, path in paths]
    return [Version(number, path, file.stat().st_mtime) for number, path, file in there if file.is_file()]


def restore(path: str, number: int) -> None:
    """Makes an earlier version the map again; what is the map now becomes the latest version.

    Raises InputError if there is no such version, MapFileError if it or the map cannot be read or written.
    """
    base = normalise_map_path(path)
    if number not in [version.number for version in versions(path)]:
        raise InputError(f"{path}: there is no version {number}; oort history lists them")
    earlier = load_map(_path_of(base, number))
    if any(Path(base + ending).exists() for ending in _FILES):
        keep_version(base)
    save_map(base, earlier)


def describe(version: Version) -> str:
    """A version in a line."""
    try:
        when = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(version.saved))
    except (OverflowError, ValueError, OSError):  # a file's time may be anything
        when = "at no time that can be"
    return f"{version.number}  kept {when}  {version.path}"


def _path_of(base: str, number: int) -> str:
    return f"{base}.previous" + (f".{number}" if number > 1 else "")
