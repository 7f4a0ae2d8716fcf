# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Floor plans that somebody has: what a drive through one needs, and a place for the dock."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from oort.errors import InputError
from oort.poses import Array, compose
from oort.simulate import furniture
from oort.simulate.floor_plan import FloorPlan, Rect, RoomPlan
from oort.simulate.free_space import NEAREST, RESOLUTION, BoolArray, ClearanceGrid
from oort.simulate.furniture import Piece
from oort.simulate.home import DOCK_FRONT, DOCK_SIZE, DOCK_TO_BASE, Home, Room

MOST_FLOOR = 500.0  # m^2 that the robot can reach; a tour of more takes an hour
WIDEST = 300.0  # m from end to end; the grid of free space spans it
TILE = 4.0  # m; the sides of the squares that a tour sees to one after the other
FREE_BEFORE = 0.35  # m of clearance on the way onto the dock, from 0.4 m before it
DOCK_CLEARANCE = (0.19, 0.31)  # m from the docked base to the wall behind it


@dataclass(frozen=True, eq=False)
class Plan:
    """A floor plan in its own frame [m]."""

    source: str
    """the file, for messages"""
    rooms: tuple[Room, ...]
    floor: Any
    """a shape of shapely: where there is floor"""
    walls: Array
    """(n, 4) x0, y0, x1, y1: what a scan hits"""
    edges: Array
    """(m, 4) of what the robot keeps away from; walls are among it"""
    pieces: tuple[Piece, ...] = ()
    """furniture"""
    dock: tuple[float, float, float] | None = None
    """the pose of the docked base; chosen at random if None"""
    notes: tuple[str, ...] = ()
    """what of the file is not in the plan"""


def furnish_plan(plan: Plan, rng: np.random.Generator) -> tuple[Home, FloorPlan, ClearanceGrid]:
    """The plan as a home with a dock, and its free space. Raises InputError if no robot can drive there."""
    import shapely

    x0, y0, x1, y1 = plan.floor.bounds
    if max(x1 - x0, y1 - y0) > WIDEST:
        raise InputError(f"{plan.source}: the floor spans {x1 - x0:.0f} x {y1 - y0:.0f} m; at most {WIDEST:.0f} m do")
    grid = ClearanceGrid(Rect(x0, y0, x1, y1).grown(0.3, 0.3))
    x, y = np.broadcast_arrays(*grid.centres())
    shapely.prepare(plan.floor)
    grid.open(shapely.contains_xy(plan.floor, x, y))
    grid.block_segments(plan.edges)
    for piece in plan.pieces:
        grid.block_polygon(piece.footprint)
    region = _largest_region(grid)
    area = float(np.count_nonzero(region)) * RESOLUTION**2
    if area > MOST_FLOOR:
        raise InputError(f"{plan.source}: a robot gets to {area:.0f} m2 of floor; at most {MOST_FLOOR:.0f} are driven")
    dock = _checked_dock(plan, grid, region) if plan.dock else _find_dock(plan, grid, region, rng)
    piece = furniture.dock(*DOCK_SIZE).moved(compose(dock, [-(DOCK_SIZE[1] + DOCK_TO_BASE), 0.0, -0.5 * np.pi]))
    grid.block_polygon(piece.footprint)
    pieces = (*plan.pieces, piece)
    solids = [np.hstack([solid, np.roll(solid, -1, axis=0)]) for piece in pieces for solid in piece.solids]
    home = Home(plan.rooms, (), pieces, np.vstack([plan.walls, *solids]), np.empty((0, 3)), dock)
    return home, FloorPlan(_tiles(grid, region), ()), grid


def _largest_region(grid: ClearanceGrid) -> BoolArray:
    """Where a robot gets to from the larger part of the floor."""
    from scipy import ndimage

    labels, count = ndimage.label(grid.clearance >= NEAREST)
    if not count:
        return np.zeros(grid.clearance.shape, dtype=np.bool_)
    return np.asarray(labels == 1 + int(np.argmax(np.bincount(labels.ravel())[1:])))


def _checked_dock(plan: Plan, grid: ClearanceGrid, region: BoolArray) -> Array:
    dock = np.array(plan.dock)
    front = dock[:2] + DOCK_FRONT * np.array([np.cos(dock[2]), np.sin(dock[2])])
    if not region[grid.cell(*front.tolist())]:
        raise InputError(
            f"{plan.source}: {DOCK_FRONT} m before the dock at x {dock[0]:.2f} m, y {dock[1]:.2f} m is no floor where "
            "the robot drives; choose another pose, or leave it out and one is found"
        )
    return dock


def _find_dock(plan: Plan, grid: ClearanceGrid, region: BoolArray, rng: np.random.Generator) -> Array:
    """A pose with a wall behind it and free floor before it; along the plan's axes if there is one."""
    low, high = DOCK_CLEARANCE
    cells = np.argwhere((grid.clearance >= low) & (grid.clearance <= high))
    cells = cells[rng.permutation(len(cells))]
    for headings in (np.arange(4) * 0.5 * np.pi, np.arange(16) * np.pi / 8.0):
        for row, column in cells.tolist():
            x, y = grid.point((row, column))
            for heading in headings[rng.permutation(len(headings))].tolist():
                if _fits(grid, region, x, y, heading):
                    return np.array([x, y, heading])
    raise InputError(
        f"{plan.source}: no place for the dock, for nowhere is a wall with {DOCK_FRONT} m of free floor before it; is "
        "the scale right? (--resolution)"
    )


def _fits(grid: ClearanceGrid, region: BoolArray, x: float, y: float, heading: float) -> bool:
    ahead = np.array([np.cos(heading), np.sin(heading)])
    here = np.array([x, y])
    behind = grid.at(*(here - 0.3 * ahead).tolist())
    before = [grid.at(*(here + way * ahead).tolist()) for way in (0.4, 0.5, 0.6, DOCK_FRONT)]
    front = grid.cell(*(here + DOCK_FRONT * ahead).tolist())
    return behind < 0.1 and min(before) >= FREE_BEFORE and bool(region[front])


def _tiles(grid: ClearanceGrid, region: BoolArray) -> tuple[RoomPlan, ...]:
    """Squares that cover where the robot gets to, as the rooms of a tour."""
    rows, columns = np.nonzero(region)
    (x0, y0), (x1, y1) = grid.point((int(rows.min()), int(columns.min()))), grid.point((rows.max(), columns.max()))
    xs, ys = (np.linspace(low, high, 1 + max(1, round((high - low) / TILE))) for low, high in ((x0, x1), (y0, y1)))
    return tuple(
        RoomPlan("floor", Rect(left, lower, right, upper))
        for lower, upper in zip(ys[:-1].tolist(), ys[1:].tolist(), strict=True)
        for left, right in zip(xs[:-1].tolist(), xs[1:].tolist(), strict=True)
    )
