# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Rooms of a map: free space cut along inner walls and their doorways.

What then hangs together is a room. Its outline is moved out to the straight walls around it, also behind furniture.
Walls run along two directions at right angles; others only bound rooms. Made for homes: docs/export.md has figures.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import ModuleType

import numpy as np

from oort._core import OccupancyGrid
from oort.errors import OortError
from oort.export.hidden_sides import Uncoverer
from oort.export.inner_walls import inner_walls
from oort.export.room_sides import Labels, Sides, box_of, snap, takes_rectangle
from oort.export.wall_frame import CELL, Array, Box, Mask, WallFrame, axis_walls, main_direction, make_frame, turn

# Fitted on the simulated homes 1 to 18 and 200 to 259, and tried on others (docs/export.md).
_SMALLEST = 1.0  # [m^2] of free floor that is a room
_OPEN = 0.5  # share of the border between two rooms beyond which they are one


@dataclass(frozen=True, eq=False)
class Room:
    """A room of a map."""

    outline: Array
    """(n, 2) corners [m] in the map's frame, counter-clockwise"""
    area: float
    """[m^2] with what stands in it"""
    open_sides: int | None
    """sides of a rectangular room on which no wall was seen, so that it may be larger; None for another shape"""
    centre: tuple[float, float]
    """a point in it [m]"""

    def holds(self, x: float, y: float) -> bool:
        """Whether a point of the map lies in it."""
        (x0, y0), (x1, y1) = self.outline.T, np.roll(self.outline, -1, axis=0).T
        crosses = (y0 > y) != (y1 > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            right = x < x0 + (y - y0) * (x1 - x0) / (y1 - y0)
        return bool((crosses & right).sum() % 2)


def find_rooms(walls: Array, grid: OccupancyGrid) -> list[Room]:
    """The rooms, the largest first, from walls (k, 4) as fit_walls() gives them.

    Raises OortError without scipy and shapely, InputError for a map that is too wide.
    """
    try:
        import shapely
        from scipy import ndimage
    except ImportError as error:
        raise OortError(f"rooms need the package {error.name}: pip install 'oort[export]'") from None
    if not len(walls) or not grid.cells.size:
        return []
    frame = make_frame(grid, main_direction(walls))
    turned = turn(walls.reshape(-1, 2), -frame.angle).reshape(-1, 4)
    across, up = axis_walls(turned, along_y=False), axis_walls(turned, along_y=True)
    inner, usual = inner_walls(across, up, frame)
    strips = [(along_y, frame.cells(_grown(box))) for along_y, box in inner]
    cut = np.zeros_like(frame.free)
    for _, window in strips:
        cut[window] = True
    labels = _join_open(ndimage.label(frame.free & ~cut)[0], frame.free, strips)
    windows = {
        k: window
        for k, window in enumerate(ndimage.find_objects(labels), 1)
        if window is not None and (labels[window] == k).sum() * CELL**2 >= _SMALLEST
    }
    snapped = [snap(k, frame.box(window), across, up) for k, window in windows.items()]
    moved = Uncoverer(frame, labels, across, up, usual).move(snapped)
    rooms = [
        _room(shapely, ndimage.binary_fill_holes, frame, labels, k, window, sides)
        for (k, window), sides in zip(windows.items(), moved, strict=True)
    ]
    return sorted(rooms, key=lambda room: -room.area)


def _room(
    shapely: ModuleType,
    fill_holes: Callable[[Mask], Mask],
    frame: WallFrame,
    labels: Labels,
    k: int,
    window: tuple[slice, slice],
    sides: Sides,
) -> Room:
    if takes_rectangle(frame, labels, sides):
        x0, y0, x1, y1 = box_of(sides)
        area, open_sides = (x1 - x0) * (y1 - y0), sum(not side.found for side in sides)
        corners = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
        outline = turn(corners, frame.angle)
        x, y = outline.mean(axis=0).tolist()
        return Room(outline, area, open_sides, (x, y))
    corners, inside, area = _trace(shapely, fill_holes(np.pad(labels[window] == k, 1)), frame.box(window))
    x, y = turn(inside, frame.angle)[0].tolist()
    return Room(turn(corners, frame.angle), area, None, (x, y))


def _join_open(labels: Labels, free: Mask, strips: Sequence[tuple[bool, tuple[slice, slice]]]) -> Labels:
    """Joins what a wall parts that is open for most of its length."""
    borders: dict[tuple[int, int], tuple[int, int]] = {}
    for along_y, (rows, columns) in strips:
        a, b, inner = (labels.T, free.T, columns) if along_y else (labels, free, rows)
        along = rows if along_y else columns
        if inner.start < 1 or inner.stop >= a.shape[0]:
            continue
        is_open = b[(inner.start + inner.stop) // 2, along]
        sides = np.sort(np.stack([a[inner.start - 1, along], a[inner.stop, along]], axis=1), axis=1)
        parted = is_open & (sides[:, 0] > 0) & (sides[:, 0] != sides[:, 1])
        pairs, openings = np.unique(sides[parted], axis=0, return_counts=True)
        for (first, second), opening in zip(pairs.tolist(), openings.tolist(), strict=True):
            wall, most = borders.get((first, second), (0, 0))
            borders[first, second] = max(wall, int((~is_open).sum())), max(most, opening)
    root = np.arange(labels.max() + 1, dtype=np.int32)
    for (first, second), (wall, opening) in sorted(borders.items()):
        if opening > _OPEN * (wall + opening):
            root[root == root[second]] = root[first]
    joined: Labels = root[labels]
    return joined


def _trace(shapely: ModuleType, mask: Mask, box: Box) -> tuple[Array, Array, float]:
    """Outline, a point inside and area of cells; the mask is a cell larger than the box on each side."""
    runs = []
    for row in np.flatnonzero(mask.any(axis=1)).tolist():
        edges = np.flatnonzero(np.diff(mask[row], prepend=False, append=False)).reshape(-1, 2)
        runs += [shapely.box(begin, row, end, row + 1) for begin, end in edges.tolist()]
    shape = shapely.union_all(runs).buffer(0)
    largest = max(shapely.get_parts(shape), key=lambda part: part.area).simplify(1.0)
    cells = np.array(shapely.geometry.polygon.orient(largest).exterior.coords)[:-1] - 1.0
    inside = np.array(largest.representative_point().coords) - 1.0
    low = np.array(box[:2])
    return low + CELL * cells, low + CELL * inside, float(largest.area) * CELL**2


def _grown(box: Box) -> Box:
    """By a cell on each side: rounding leaves no leak."""
    return box[0] - CELL, box[1] - CELL, box[2] + CELL, box[3] + CELL
