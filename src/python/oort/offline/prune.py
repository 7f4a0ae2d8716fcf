# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a saved map with only the views that it needs."""

from oort._core import Map, normalise_map_path, prune_map, save_map
from oort.errors import InputError
from oort.saved_maps import open_map


def prune(source: str, target: str, views: int, *, ignore_checksum: bool = False) -> str:
    """Writes a map without what is seen often enough from elsewhere, or contradicted since; returns what to print.

    ``views``: of a piece of surface from one side. Raises InputError if both paths are of the same map, MapFileError.
    """
    if normalise_map_path(source) == normalise_map_path(target):
        raise InputError(f"{target}: the new map would replace the old one; choose another place")
    map_ = open_map(source, ignore_checksum=ignore_checksum)
    pruned = prune_map(map_, views)
    save_map(target, pruned)
    return f"{source}: {_size(map_)}\n{target}: {_size(pruned)}"


def _size(map_: Map) -> str:
    return f"{len(map_)} nodes, {len(map_.switchable_edges['i'])} closures"
