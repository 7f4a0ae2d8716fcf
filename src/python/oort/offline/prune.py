# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a saved map with only the views that it needs."""

from pathlib import Path
from typing import Any

from oort._core import SWITCH_ON, Map, normalise_map_path, prune_map, save_map
from oort.errors import InputError
from oort.export.files import make_folder
from oort.interrupts import interruptible
from oort.saved_maps import open_map


def prune(source: str, target: str, views: int, *, ignore_checksum: bool = False) -> dict[str, dict[str, Any]]:
    """Writes a map without what is seen often enough from elsewhere, or contradicted since; tells of both.

    ``views``: of a piece of surface from one side. Raises InputError if both paths are of the same map, MapFileError.
    """
    if normalise_map_path(source) == normalise_map_path(target):
        raise InputError(f"{target}: the new map would replace the old one; choose another place")
    map_ = open_map(source, ignore_checksum=ignore_checksum)
    make_folder(Path(normalise_map_path(target)).parent)
    with interruptible():
        pruned = prune_map(map_, views)
    save_map(target, pruned)
    return {"source": _figures(source, map_), "target": _figures(target, pruned)}


def _figures(path: str, map_: Map) -> dict[str, Any]:
    return {"path": path, "nodes": len(map_), "closures": int((map_.switchable_edges["switch"] >= SWITCH_ON).sum())}
