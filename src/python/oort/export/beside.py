# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Loose parts of a map in pictures of it: beside what is tied, as where they lie on it is not known."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oort._core import Map, OccupancyGrid, Parameters, render_map
from oort.errors import InputError

_GAP = 0.5  # [m] between the map and its parts
_UNKNOWN = -1  # of cells
_LARGEST = 4000  # cells along a side of the whole picture, or
_GROWTH = 2  # times the longer side of the map
_CAPTION = "not tied: its place is not known"


@dataclass(frozen=True, eq=False)
class Beside:
    """A map with its loose parts to the right of it."""

    cells: NDArray[np.int8]
    """(height, width), of the same resolution and origin as the map's"""
    shift: NDArray[np.float64]
    """(N, 2) [m] by which each node is drawn away from its pose; NaN if it is not drawn"""
    part: NDArray[np.int64]
    """(N,) the number of each node's loose part, -1 of the main one"""
    captions: list[tuple[str, tuple[float, float]]]
    """texts and where they begin [m]"""

    def ends(self, i: NDArray[np.uint64], j: NDArray[np.uint64]) -> NDArray[np.uint64]:
        """(k, 2): the nodes between which to draw each edge; the first one twice if they are of different parts."""
        return np.stack([i, np.where(self.part[i] == self.part[j], j, i)], axis=1).reshape(-1, 2)


def set_beside(map_: Map, grid: OccupancyGrid, parameters: Parameters) -> Beside:
    """The drawn map ``grid`` with what lies apart from it. Parts for which there is no room are left out."""
    shift, part = np.zeros((len(map_), 2)), np.full(len(map_), -1, dtype=np.int64)
    cells = np.asarray(grid.cells)
    captions: list[tuple[str, tuple[float, float]]] = []
    gap = max(1, round(_GAP / grid.resolution))
    column, row, widest = cells.shape[1] + gap, 0, 0
    largest = max(_LARGEST, _GROWTH * max(cells.shape))
    for number, nodes in enumerate(map_.loose_parts):
        part[nodes], shift[nodes] = number, np.nan
        drawn = _draw(map_, nodes, grid.resolution, parameters)
        if drawn is None:
            continue
        if row > 0 and row + drawn.cells.shape[0] > cells.shape[0]:  # another column
            column, row, widest = column + widest + gap, 0, 0
        if max(column + drawn.cells.shape[1], row + drawn.cells.shape[0]) > largest:
            continue
        cells = _paste(cells, np.asarray(drawn.cells), row, column)
        corner = np.array(grid.origin) + np.array([column, row]) * grid.resolution
        shift[nodes] = corner - np.array(drawn.origin)
        captions.append((_CAPTION, (float(corner[0]), float(corner[1]) + drawn.cells.shape[0] * grid.resolution)))
        row, widest = row + drawn.cells.shape[0] + gap, max(widest, drawn.cells.shape[1])
    return Beside(cells, shift, part, captions)


def _draw(map_: Map, nodes: NDArray[np.uint64], resolution: float, parameters: Parameters) -> OccupancyGrid | None:
    """None if it cannot be drawn at this resolution."""
    try:
        drawn = render_map(map_, parameters, nodes=nodes.tolist())[0]
    except InputError:
        return None
    return drawn if drawn.resolution == resolution else None


def _paste(cells: NDArray[np.int8], patch: NDArray[np.int8], row: int, column: int) -> NDArray[np.int8]:
    """Row 0 is the lowest."""
    height, width = max(cells.shape[0], row + patch.shape[0]), max(cells.shape[1], column + patch.shape[1])
    larger = np.full((height, width), _UNKNOWN, dtype=np.int8)
    larger[: cells.shape[0], : cells.shape[1]] = cells
    larger[row : row + patch.shape[0], column : column + patch.shape[1]] = patch
    return larger
