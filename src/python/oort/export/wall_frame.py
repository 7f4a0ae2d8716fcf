# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The frame of a home's walls: turned so that they run along its axes, with free cells."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oort._core import OccupancyGrid
from oort.errors import InputError

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Box = tuple[float, float, float, float]
"""x0, y0, x1, y1 [m]"""

CELL = 0.05
"""[m]"""

_MOST = 1.5e8  # cells of a frame, 2 GB: the widest square map that is drawn at 5 cm, turned by any angle
_AT_A_TIME = 1 << 20  # cells that are looked up together
_NEAR, _FAR = 0.06, 0.22  # [m] from a face: the strip that tells from which side it was seen


@dataclass(frozen=True, eq=False)
class WallFrame:
    """x, y of the map turned by ``-angle``; cells from ``low`` on."""

    angle: float
    low: Array
    free: Mask
    """(rows along y, columns along x)"""

    def cells(self, box: Box) -> tuple[slice, slice]:
        """The cells of a rectangle, one at least each way."""
        x0, y0, x1, y1 = box
        c = np.round((np.array([x0, x1]) - self.low[0]) / CELL).astype(int).clip(0, self.free.shape[1])
        r = np.round((np.array([y0, y1]) - self.low[1]) / CELL).astype(int).clip(0, self.free.shape[0])
        return slice(int(r[0]), max(int(r[1]), int(r[0]) + 1)), slice(int(c[0]), max(int(c[1]), int(c[0]) + 1))

    def box(self, window: tuple[slice, slice]) -> Box:
        """The rectangle of cells."""
        rows, columns = window
        x = self.low[0] + CELL * np.array([columns.start, columns.stop])
        y = self.low[1] + CELL * np.array([rows.start, rows.stop])
        return float(x[0]), float(y[0]), float(x[1]), float(y[1])

    def free_beside(self, walls: Array, along_y: bool, side: float) -> Array:
        """Share of free cells beside each wall, (k, 3) as axis_walls() gives them; side 1: where it is farther out."""
        shares = []
        for at, begin, end in walls.tolist():
            low, high = sorted((at + side * _NEAR, at + side * _FAR))
            strip = self.free[self.cells(oriented(along_y, low, high, begin, end))]
            shares.append(strip.mean() if strip.size else 0.0)
        return np.array(shares)


def oriented(along_y: bool, low: float, high: float, begin: float, end: float) -> Box:
    """The box of what reaches from low to high across a wall and from begin to end along it."""
    return (low, begin, high, end) if along_y else (begin, low, end, high)


def make_frame(grid: OccupancyGrid, angle: float) -> WallFrame:
    """Free cells in the frame of the walls. Raises InputError for a map that is too wide."""
    size = grid.resolution * np.array([grid.width, grid.height])
    turned = turn(np.array(grid.origin) + size * np.array([[0, 0], [1, 0], [1, 1], [0, 1]]), -angle)
    low, high = turned.min(axis=0), turned.max(axis=0)
    columns, rows = np.ceil((high - low) / CELL).astype(int).tolist()
    if columns * rows > _MOST:
        raise InputError(f"rooms are not looked for in a map of {high[0] - low[0]:.0f} m x {high[1] - low[1]:.0f} m")
    cells, c, s = grid.cells, np.cos(angle), np.sin(angle)
    x = low[0] + CELL * (np.arange(columns) + 0.5)
    free = np.zeros((rows, columns), dtype=np.bool_)
    step = max(1, _AT_A_TIME // columns)
    for first in range(0, rows, step):  # numbers of all cells at once would take gigabytes
        part = free[first : first + step]
        y = low[1] + CELL * (first + np.arange(len(part))[:, None] + 0.5)
        column = np.floor((x * c - y * s - grid.origin[0]) / grid.resolution).astype(np.int32)
        row = np.floor((x * s + y * c - grid.origin[1]) / grid.resolution).astype(np.int32)
        inside = (column >= 0) & (column < grid.width) & (row >= 0) & (row < grid.height)
        part[inside] = cells[row[inside], column[inside]] == 0
    return WallFrame(angle, low, free)


def main_direction(walls: Array) -> float:
    """The direction [rad], in [-pi/4, pi/4), of most wall, or at right angles to it; walls (k, 4) x0, y0, x1, y1."""
    along = walls[:, 2:] - walls[:, :2]
    weights = np.linalg.norm(along, axis=1)
    quadruple = 4.0 * np.arctan2(along[:, 1], along[:, 0])
    best = np.linspace(-np.pi, np.pi, 180, endpoint=False)
    votes = (weights * (np.cos(best[:, None] - quadruple) > np.cos(np.radians(12.0)))).sum(axis=1)
    near = np.cos(best[votes.argmax()] - quadruple) > np.cos(np.radians(16.0))
    w = weights[near] ** 2
    return float(np.arctan2((w * np.sin(quadruple[near])).sum(), (w * np.cos(quadruple[near])).sum()) / 4.0)


def turn(points: Array, angle: float) -> Array:
    """Points (n, 2) turned about the origin."""
    c, s = np.cos(angle), np.sin(angle)
    turned: Array = points @ np.array([[c, s], [-s, c]])
    return turned


def axis_walls(turned: Array, along_y: bool) -> Array:
    """(k, 3) of walls (n, 4) in the frame: those along one axis: where across it, from, to."""
    ends = turned.reshape(-1, 2, 2)
    axis = int(along_y)
    along, off = ends[:, :, axis], ends[:, :, 1 - axis]
    straight = np.abs(np.diff(off, axis=1)[:, 0]) <= 0.1 * np.abs(np.diff(along, axis=1)[:, 0])
    return np.column_stack([off.mean(axis=1), along.min(axis=1), along.max(axis=1)])[straight]


def covered(pieces: Array, begin: float, end: float) -> float:
    """[m] of a stretch that pieces (k, 2) cover together."""
    total, reached = 0.0, begin
    for low, high in sorted(np.clip(pieces, begin, end).tolist()):
        total += max(0.0, high - max(low, reached))
        reached = max(reached, high)
    return total
