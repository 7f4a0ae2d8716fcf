# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Free space of a home as a grid of distances to the nearest obstacle, and shortest paths through it."""

import heapq
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from oort.poses import Array
from oort.simulate.floor_plan import Rect

RESOLUTION = 0.1  # m per cell
FARTHEST = 1.0  # m; clearances beyond this are not told apart
NEAREST = 0.25  # m; no planned cell is closer to an obstacle
COMFORT = 0.6  # m; below this clearance a path costs more
DISCOMFORT = 3.0  # how many times more at no clearance

Cell = tuple[int, int]
BoolArray = npt.NDArray[np.bool_]


class ClearanceGrid:
    """Distance [m] from each cell's centre to the nearest obstacle, 0 inside obstacles, at most ``FARTHEST``.

    ``clearance`` is (rows, columns) with the row along y. All is blocked until it is opened.
    """

    def __init__(self, bounds: Rect) -> None:
        """Make a grid over ``bounds`` with nothing free in it."""
        self._x0, self._y0 = bounds.x0 + 0.5 * RESOLUTION, bounds.y0 + 0.5 * RESOLUTION
        shape = (int(np.ceil(bounds.height / RESOLUTION)), int(np.ceil(bounds.width / RESOLUTION)))
        self.clearance: Array = np.zeros(shape)

    def cell(self, x: float, y: float) -> Cell:
        """The cell (row, column) that holds a point, the border's cell for a point outside."""
        rows, columns = self.clearance.shape
        row, column = round((y - self._y0) / RESOLUTION), round((x - self._x0) / RESOLUTION)
        return min(max(row, 0), rows - 1), min(max(column, 0), columns - 1)

    def point(self, cell: Cell) -> tuple[float, float]:
        """The centre of a cell."""
        return self._x0 + cell[1] * RESOLUTION, self._y0 + cell[0] * RESOLUTION

    def at(self, x: float, y: float) -> float:
        """Clearance at a point: that of its cell."""
        return float(self.clearance[self.cell(x, y)])

    def window(self, rect: Rect) -> tuple[slice, slice]:
        """Rows and columns of the cells of a rectangle."""
        row0, column0 = self.cell(rect.x0, rect.y0)
        row1, column1 = self.cell(rect.x1, rect.y1)
        return slice(row0, row1 + 1), slice(column0, column1 + 1)

    def inside(self, rect: Rect) -> BoolArray:
        """Mask of the cells whose centres lie in a rectangle."""
        x, y = self.centres()
        return (x >= rect.x0) & (x <= rect.x1) & (y >= rect.y0) & (y <= rect.y1)

    def open_rect(self, rect: Rect) -> None:
        """Declare the cells of a rectangle free; obstacles are blocked afterwards."""
        self.open(self.inside(rect))

    def open(self, free: BoolArray) -> None:
        """Declare cells free; obstacles are blocked afterwards."""
        self.clearance[free] = FARTHEST

    def block_segments(self, segments: Array) -> None:
        """Lower the clearance around line segments (n, 4) of x0, y0, x1, y1."""
        for x0, y0, x1, y1 in segments:
            rect = Rect(min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)).grown(FARTHEST, FARTHEST)
            window = self.window(rect)
            x, y = self.centres(window)
            dx, dy = x1 - x0, y1 - y0
            along = np.clip(((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy), 0.0, 1.0)
            distance = np.hypot(x - x0 - along * dx, y - y0 - along * dy)
            self.clearance[window] = np.minimum(self.clearance[window], distance)

    def block_polygon(self, corners: Array) -> None:
        """Lower the clearance in and around a convex polygon (n, 2), counter-clockwise."""
        following = np.roll(corners, -1, axis=0)
        self.block_segments(np.hstack([corners, following]))
        low, high = corners.min(axis=0), corners.max(axis=0)
        window = self.window(Rect(low[0], low[1], high[0], high[1]))
        x, y = self.centres(window)
        inside = np.ones(np.broadcast_shapes(x.shape, y.shape), dtype=bool)
        for (ax, ay), (bx, by) in zip(corners, following, strict=True):
            inside &= (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0.0
        self.clearance[window][inside] = 0.0

    def centres(self, window: tuple[slice, slice] = (slice(None), slice(None))) -> tuple[Array, Array]:
        """Coordinates of the cells' centres of a window (default: all): x as a row, y as a column."""
        rows, columns = self.clearance.shape
        y = self._y0 + RESOLUTION * np.arange(rows, dtype=np.float64)[window[0], None]
        x = self._x0 + RESOLUTION * np.arange(columns, dtype=np.float64)[None, window[1]]
        return x, y


def flood(passable: BoolArray, start: Cell) -> BoolArray:
    """Mask of the cells that four-neighbour steps over ``passable`` cells reach from ``start``."""
    reached = np.zeros_like(passable)
    reached[start] = passable[start]
    count = 0
    while count != (count := int(np.count_nonzero(reached))):
        grown = reached.copy()
        grown[1:] |= reached[:-1]
        grown[:-1] |= reached[1:]
        grown[:, 1:] |= reached[:, :-1]
        grown[:, :-1] |= reached[:, 1:]
        reached = grown & passable
    return reached


@dataclass(frozen=True, eq=False)
class Routes:
    """Cheapest ways from one cell to all others: per cell the cost [m, discomfort included] and the cell before it."""

    cost: Array
    before: npt.NDArray[np.int64]


def find_routes(grid: ClearanceGrid, start: Cell) -> Routes:
    """Dijkstra's algorithm over eight neighbours, with a cost that keeps paths away from obstacles.

    Cells with less clearance than ``NEAREST`` are closed; cells that are not reached have infinite cost.
    """
    rows, columns = grid.clearance.shape
    weight = 1.0 + DISCOMFORT * np.maximum(0.0, 1.0 - grid.clearance / COMFORT)
    weight[grid.clearance < NEAREST] = np.inf
    # A closed rim of one cell spares the inner loop all tests of the border.
    price = np.pad(weight, 1, constant_values=np.inf).ravel().tolist()
    stride = columns + 2
    steps = [(dr * stride + dc, RESOLUTION * float(np.hypot(dr, dc))) for dr, dc in _NEIGHBOURS]
    cost = [np.inf] * len(price)
    before = [-1] * len(price)
    first = (start[0] + 1) * stride + start[1] + 1
    cost[first] = 0.0
    queue = [(0.0, first)]
    while queue:
        cost_here, here = heapq.heappop(queue)
        if cost_here > cost[here]:
            continue
        for offset, length in steps:
            there = here + offset
            cost_there = cost_here + length * price[there]
            if cost_there < cost[there]:
                cost[there], before[there] = cost_there, here
                heapq.heappush(queue, (cost_there, there))
    inner = (slice(1, rows + 1), slice(1, columns + 1))
    return Routes(np.array(cost).reshape(-1, stride)[inner], np.array(before).reshape(-1, stride)[inner])


_NEIGHBOURS = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))


def trace(grid: ClearanceGrid, routes: Routes, goal: Cell) -> Array:
    """Points (n, 2) of the cheapest way from the routes' start to ``goal``, one per cell, both ends included."""
    stride = grid.clearance.shape[1] + 2
    points = [grid.point(goal)]
    cell = goal
    while (code := int(routes.before[cell])) >= 0:
        cell = (code // stride - 1, code % stride - 1)
        points.append(grid.point(cell))
    return np.array(points[::-1])


def smooth(grid: ClearanceGrid, points: Array, passes: int = 30) -> Array:
    """The path with its grid corners rounded, its ends kept, and no point moved closer than ``NEAREST``."""
    path = points.copy()
    for _ in range(passes):
        moved = 0.25 * path[:-2] + 0.5 * path[1:-1] + 0.25 * path[2:]
        clear = [grid.at(x, y) >= NEAREST for x, y in moved.tolist()]
        path[1:-1] = np.where(np.array(clear, dtype=bool)[:, None], moved, path[1:-1])
    return path
