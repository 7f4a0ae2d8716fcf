# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Joins two saved maps of the same home into one."""

from collections.abc import Generator
from pathlib import Path
from typing import Any

import numpy as np

from oort._core import (
    SWITCH_ON,
    Map,
    Merged,
    OccupancyGrid,
    Parameters,
    merge_maps,
    normalise_map_path,
    prune_map,
    save_map,
)
from oort.areas import areas_of_map, is_area
from oort.errors import InputError
from oort.export import write_picture
from oort.export.files import make_folder
from oort.interrupts import interruptible
from oort.offline.drawing import draw_map
from oort.poses import compose
from oort.recording import Pose
from oort.saved_maps import open_map

__all__ = ["Merged", "merge", "merge_maps"]

_FOUND_BY = {"given": "where --at says", "dock": "at the dock", "search": "by a search of the whole map"}


def merge(
    first: str,
    second: str,
    target: str,
    parameters: Parameters,
    at: Pose | None = None,
    *,
    ignore_checksum: bool = False,
) -> Generator[str, None, dict[str, Any]]:
    """Joins the map at a path with another and saves it, with a picture beside it.

    Yields what to print on the way and returns the figures.

    ``at`` is about where the second map's origin lies on the first [m, rad]; found if not given. Raises InputError if
    two of the paths are of the same map, MapFileError, what merge_maps() raises, and at last, with the map saved and
    all told, OortError if the picture cannot be written.
    """
    paths = [normalise_map_path(path) for path in (first, second, target)]
    if paths[0] == paths[1]:
        raise InputError(f"{first}: both maps are the same one; give two maps of different drives")
    if paths[2] in paths[:2]:
        raise InputError(f"{target}: the new map would replace one of the two; choose another place")
    a = open_map(first, ignore_checksum=ignore_checksum)
    b = open_map(second, ignore_checksum=ignore_checksum)
    yield f"{first}: {len(a)} nodes"
    yield f"{second}: {len(b)} nodes"
    yield "looking for where the second map lies on the first, and for closures across"
    make_folder(Path(paths[2]).parent)
    with interruptible():
        merged = merge_maps(a, b, parameters, at)
        map_ = merged.map
        pruned = _pruned(map_, int(parameters.get("keep_views")))
    save_map(target, pruned)
    yield from _told(merged)
    if len(pruned) < len(map_):
        yield f"left out {len(map_) - len(pruned)} of {len(map_)} nodes that show what others do (keep_views)"
    yield f"{target}: {len(pruned)} nodes"
    (grid, _), notes = draw_map(map_, parameters)
    yield from notes
    picture = f"{paths[2]}.png"
    drawn = _draw(picture, merged, map_, grid)
    if drawn:
        yield f"wrote {picture}"
    return {
        "nodes": {"first": len(a), "second": len(b), "target": len(pruned)},
        "T_first_second": list(merged.T_a_b),
        "found_by": merged.found_by,
        "views": {"all": merged.views, "fit": merged.views_that_fit, "contradict": merged.views_that_contradict},
        "closures": {**merged.closures, "kept": merged.closures_kept},
        "dropped_places": [{"space": space, "id": id_, "distance": apart} for space, id_, apart in merged.dropped],
        "map": target,
        "picture": picture if drawn else None,
    }


def _pruned(map_: Map, views: int) -> Map:
    """What is saved: a map of many drives stays as large as the home."""
    return prune_map(map_, views, always=False) if views > 0 else map_


def _told(merged: Merged) -> list[str]:
    x, y, theta = merged.T_a_b
    closures = merged.closures
    rejected = ", ".join(f"{why} {n}" for why, n in sorted(closures["rejected"].items()) if n)
    lines = [
        f"the second map's origin was found at x {x:z.2f} m, y {y:z.2f} m, theta {theta:z.3f} rad of the first, "
        f"{_FOUND_BY[merged.found_by]}: of {merged.views} views {merged.views_that_fit} fit there, "
        f"{merged.views_that_contradict} contradict",
        f"closures across: {closures['tried']} tried, {closures['accepted']} accepted, {merged.closures_kept} kept"
        + (f"; rejected: {rejected}" if rejected else ""),
    ]
    lines += [
        f"place {space}/{id}: the first map's is kept; the second's lies {distance:.2f} m from it"
        for space, id, distance in merged.dropped
    ]
    return lines


def _draw(path: str, merged: Merged, map_: Map, grid: OccupancyGrid) -> bool:
    """The map with the second one's way, and the closures across; False if there is nothing to draw."""
    if not grid.cells.size:
        return False
    edges, poses = map_.switchable_edges, map_.node_poses
    across = (edges["i"] < merged.first_node_b) != (edges["j"] < merged.first_node_b)
    ends = np.stack([poses[edges["i"], :2], poses[edges["j"], :2]], axis=1)
    on = edges["switch"] >= SWITCH_ON
    places = [
        (f"{space}/{id}", compose(poses[node], pose).tolist())
        for space, id, node, pose in map_.locations
        if not is_area(space)
    ]
    write_picture(
        path,
        grid.cells,
        grid.resolution,
        (*grid.origin, 0.0),
        trajectory=poses[merged.first_node_b :],
        accepted=ends[across & on],
        undone=ends[across & ~on],
        locations=[(name, (x, y, theta)) for name, (x, y, theta) in places],
        areas=areas_of_map(map_),
    )
    return True
