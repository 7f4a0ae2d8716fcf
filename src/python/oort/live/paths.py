# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The paths that a live session saves to: absolute, in a folder that is there, and not over another map."""

import os
from pathlib import Path
from typing import Any

from oort._core import normalise_map_path
from oort.errors import MapFileError, StateError
from oort.history import keep_version

_FILES = (".map_capnp", ".map_meta_capnp", ".md5")


def check_absolute(call: str, path: Any) -> None:
    """Raises StateError for a relative path: nobody knows what a node's paths would be relative to."""
    if isinstance(path, str) and path and not os.path.isabs(path):
        raise StateError(f"{call}: the path {path!r} is not absolute; give the whole path, such as /home/me/map")


def make_room(call: str, path: str) -> None:
    """Makes the folder that a map will be saved into. Raises MapFileError now rather than after the drive."""
    folder = Path(normalise_map_path(path)).parent
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise MapFileError(f"{call}: the folder {folder} cannot be made: {error.strerror}") from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise MapFileError(f"{call}: the folder {folder} cannot be written to; choose another path")


def set_aside(call: str, path: str) -> str:
    """Keeps the map that is saved at a path as a version; the copy's path, or nothing if there is no map.

    Raises MapFileError if there is a map that cannot be copied, so that it will not be overwritten.
    """
    base = normalise_map_path(path)
    try:
        return keep_version(base)
    except MapFileError as error:
        if not any(os.path.lexists(base + ending) for ending in _FILES):
            return ""  # at most the begin of a first save, which was cut short
        raise MapFileError(
            f"{call}: {base} holds another map, which cannot be kept as {base}.previous ({error}); move its files "
            "away, or give another path"
        ) from error
