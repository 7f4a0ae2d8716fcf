# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Maps of map_server (nav2, amcl) to find and follow a robot on: a picture of a place, without a graph."""

import os

import numpy as np
from numpy.typing import NDArray

from oort._core import Map, map_of_views
from oort.errors import InputError
from oort.export.map_server import GridMap, read_map_server
from oort.poses import compose
from oort.saved_maps import open_map

_SPACING = 1.0  # [m] between the places on free floor from which the picture is looked at
_RANGE = 8.0  # [m] that is seen from there
_BEAMS = 360
_STEP = 0.5  # cells along a beam


def open_reference_map(path: str, *, ignore_checksum: bool = False) -> Map:
    """A map to localise on: a saved Oort map, or the .yaml of one of map_server. Raises MapFileError, InputError."""
    if os.path.splitext(path)[1].lower() in (".yaml", ".yml") and os.path.isfile(path):
        return map_of_image(read_map_server(path), path)
    return open_map(path, ignore_checksum=ignore_checksum)


def map_of_image(grid: GridMap, name: str = "the map") -> Map:
    """What would be seen of an occupancy grid from places all over its free floor, as a map without a graph.

    It has the grid's frame. Raises InputError if there is no free floor, or no wall in view of it.
    """
    places = _places(grid)
    if not len(places):
        raise InputError(f"{name} has no free cell, so no robot can be on it")
    bearings = 2.0 * np.pi * np.arange(_BEAMS) / _BEAMS
    views = [_look(grid, place, bearings) for place in places]
    if not any(len(view) for view in views):
        raise InputError(f"{name} has no occupied cell in view of its free ones, so there is nothing to match with")
    on_grid = np.column_stack([(places + 0.5) * grid.resolution, np.zeros(len(places))])
    poses = compose(np.array(grid.origin), on_grid)
    return map_of_views([tuple(pose) for pose in poses.tolist()], [view.tolist() for view in views])


def _places(grid: GridMap) -> NDArray[np.float64]:
    """(n, 2) cells x, y on free floor, about a spacing apart."""
    spacing = max(1, round(_SPACING / grid.resolution))
    rows, columns = np.nonzero(grid.cells == 0)
    blocks = np.column_stack([rows // spacing, columns // spacing])
    middle = np.hypot(rows % spacing - spacing / 2, columns % spacing - spacing / 2)
    order = np.lexsort((middle, blocks[:, 1], blocks[:, 0]))  # of each block its free cell nearest to the middle
    _, first = np.unique(blocks[order], axis=0, return_index=True)
    chosen = order[first]
    return np.column_stack([columns[chosen], rows[chosen]]).astype(np.float64)


def _look(grid: GridMap, place: NDArray[np.float64], bearings: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, 2) where beams from a cell's middle first meet an occupied cell [m], seen from there."""
    along = np.arange(_STEP, _RANGE / grid.resolution, _STEP)
    ray = np.stack([np.cos(bearings), np.sin(bearings)], axis=-1)
    at = place + 0.5 + ray[:, None, :] * along[None, :, None]  # (beams, steps, 2) in cells
    columns, rows = (np.floor(at[..., axis]).astype(np.int64) for axis in (0, 1))
    height, width = grid.cells.shape
    inside = (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
    hit = inside & (grid.cells[np.clip(rows, 0, height - 1), np.clip(columns, 0, width - 1)] == 100)
    seen = hit.any(axis=1)
    distance = along[hit.argmax(axis=1)] * grid.resolution
    return np.asarray((ray * distance[:, None])[seen])
