# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Opens the saved map that a person or a robot names, and says what it is if it is none."""

import logging
import os
from pathlib import Path

from oort._core import Map, load_map, normalise_map_path
from oort.errors import MapFileError
from oort.recording.foreign import name_foreign

_MAP, _OTHERS = ".map_capnp", (".map_meta_capnp", ".md5", ".map_capnp.new", ".map_meta_capnp.new", ".md5.new")
_IMAGES = (".yaml", ".yml", ".pgm", ".png")
_MAPS_OF_OTHERS = {
    ".pbstream": "a map of Cartographer",
    ".posegraph": "a map of slam_toolbox",
    ".bag": "a recording",
    ".db": "perhaps a map of RTAB-Map",
}


def open_map(path: str, *, ignore_checksum: bool = False) -> Map:
    """Loads a map by its base path or one of its files. Raises MapFileError.

    A .map_capnp file alone is read unchecked, with a warning in the log: its checksum and named places are not there.
    """
    if "\0" in path:
        raise MapFileError(f"the map's path holds a NUL character: {path!r}")
    base = normalise_map_path(path)
    if not ignore_checksum and _is_lone(base):
        logging.getLogger("oort").warning(
            "%s%s lies there alone: it was read without a check against its .md5, and without the named places of "
            "its .map_meta_capnp",
            base,
            _MAP,
        )
        ignore_checksum = True
    elif not os.path.lexists(base + _MAP) and (other := _name_other(path)):
        raise MapFileError(f"{other}; an Oort map is given by its .map_capnp file, or its path without that ending")
    try:
        return load_map(path, ignore_checksum)
    except MapFileError as error:
        if foreign := _name_pointer(Path(base + _MAP)):
            raise MapFileError(f"{base}{_MAP} is {foreign}") from None
        if "ignore_checksum" in str(error):
            raise MapFileError(f"{error}; the tools do so with --ignore-checksum") from None
        raise


def _is_lone(base: str) -> bool:
    return os.path.isfile(base + _MAP) and not any(os.path.lexists(base + ending) for ending in _OTHERS)


def _name_other(path: str) -> str:
    """What is at a path that holds no Oort map, if that can be told."""
    for candidate in (path, *(path + ending for ending in _IMAGES)):
        ending = os.path.splitext(candidate)[1].lower()
        if not os.path.isfile(candidate):
            continue
        if ending in _IMAGES:
            return (
                f"{candidate} is an image for map_server, not an Oort map: it holds no scans to match "
                "with or to go on from; only 'oort localize' takes its .yaml. Map the place with 'oort replay'"
            )
        if ending in _MAPS_OF_OTHERS:
            return f"{candidate} is {_MAPS_OF_OTHERS[ending]}, not an Oort map"
    if os.path.isfile(path) and not any(os.path.lexists(normalise_map_path(path) + ending) for ending in _OTHERS):
        return f"{path} is a file of another kind"
    return ""


def _name_pointer(path: Path) -> str:
    try:
        with path.open("rb") as stream:
            return name_foreign(path, stream.read(1024))
    except OSError:
        return ""
