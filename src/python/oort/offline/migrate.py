# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a saved map in the newest format, or as the original Oort did."""

from pathlib import Path
from typing import Any

from oort._core import FORMAT_VERSION, normalise_map_path, read_map_format, save_map
from oort.errors import InputError
from oort.export.files import make_folder
from oort.saved_maps import open_map


def migrate(
    source: str, target: str, *, to_original: bool = False, ignore_checksum: bool = False
) -> dict[str, dict[str, Any]]:
    """Writes a map in another format, with the same content; tells of both.

    Raises InputError if both are the same map, and MapFileError.
    """
    if normalise_map_path(source) == normalise_map_path(target):
        raise InputError(f"{target}: the new map would replace the old one; choose another place")
    map_ = open_map(source, ignore_checksum=ignore_checksum)
    old = read_map_format(source, ignore_checksum=True)
    make_folder(Path(normalise_map_path(target)).parent)
    save_map(target, map_, as_original=to_original)
    new = 0 if to_original else FORMAT_VERSION
    return {
        "source": {"path": source, "format": old.version, "written_by": old.written_by, "nodes": len(map_)},
        "target": {"path": target, "format": new},
    }
