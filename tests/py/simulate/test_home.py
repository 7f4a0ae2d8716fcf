# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Made-up homes: plausible, furnished without blocking the way, different for each seed."""

import numpy as np
import pytest

from oort.simulate.floor_plan import AREA, ROOMS
from oort.simulate.free_space import COMFORT, DISCOMFORT, NEAREST, find_routes, flood, smooth, trace
from oort.simulate.furniture import overlap
from oort.simulate.home import DOCK_FRONT, make_home
from oort.simulate.planar import transform

SEEDS = range(20)


def rng(seed: int) -> np.random.Generator:
    return np.random.Generator(np.random.PCG64(seed))


@pytest.mark.parametrize("seed", SEEDS)
def test_a_home_has_the_rooms_of_a_home(seed: int) -> None:
    home, plan, _ = make_home(rng(seed))
    assert ROOMS[0] <= len(home.rooms) <= ROOMS[1]
    assert AREA[0] <= home.area <= AREA[1]
    kinds = [room.kind for room in home.rooms]
    assert kinds.count("living room") == kinds.count("kitchen") == kinds.count("bathroom") == 1
    assert len(plan.doorways) >= len(plan.rooms) - 1
    assert all(doorway.width >= 0.79 for doorway in plan.doorways)


@pytest.mark.parametrize("seed", SEEDS)
def test_every_room_is_reachable_from_the_dock(seed: int) -> None:
    home, plan, grid = make_home(rng(seed))
    front = transform(home.dock, [DOCK_FRONT, 0.0])
    reached = flood(grid.clearance >= NEAREST, grid.cell(float(front[0]), float(front[1])))
    for room in plan.rooms:
        assert np.count_nonzero(reached & grid.inside(room.rect)) * 0.01 > 0.12 * room.rect.area, room.kind


@pytest.mark.parametrize("seed", SEEDS)
def test_pieces_stand_apart_and_in_a_room(seed: int) -> None:
    home, _, _ = make_home(rng(seed))
    for i, piece in enumerate(home.pieces):
        assert not any(overlap(piece.footprint, other.footprint) for other in home.pieces[:i])
        low, high = piece.footprint.min(axis=0), piece.footprint.max(axis=0)
        assert any(
            np.all(low >= room.corners[0] - 1e-5) and np.all(high <= room.corners[2] + 1e-5) for room in home.rooms
        )


def test_walls_close_but_for_doorways() -> None:
    """Each end of a wall's face or of a jamb is the end of one other, so that a beam finds no slit."""
    home, plan, _ = make_home(rng(3))
    walls = home.segments[: len(home.segments) - sum(len(s) for piece in home.pieces for s in piece.solids)]
    ends, counts = np.unique(np.round(walls.reshape(-1, 2), 6), axis=0, return_counts=True)
    assert len(ends) == 4 * len(plan.rooms) + 4 * len(plan.doorways)
    assert np.all(counts == 2)


def test_seeds_make_different_homes() -> None:
    outlines = {make_home(rng(seed))[0].segments.tobytes() for seed in SEEDS}
    assert len(outlines) == len(SEEDS)
    assert make_home(rng(1))[0].segments.tobytes() == make_home(rng(1))[0].segments.tobytes()


def test_overlap_of_polygons() -> None:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    assert overlap(square, square + 0.5)
    assert not overlap(square, square + np.array([1.0, 0.0]))
    diamond = np.array([[0.0, -0.6], [0.6, 0.0], [0.0, 0.6], [-0.6, 0.0]])
    assert not overlap(square, diamond + 1.4)
    assert overlap(square, diamond + 1.2)


def test_clearance_is_the_distance_to_the_nearest_obstacle() -> None:
    home, plan, grid = make_home(rng(2))
    sides = [np.hstack([p.footprint, np.roll(p.footprint, -1, axis=0)]) for p in home.pieces]
    obstacles = np.vstack([home.segments, *sides])
    start, side = obstacles[:, :2], obstacles[:, 2:] - obstacles[:, :2]
    living = next(room.rect for room in plan.rooms if room.kind == "living room")
    checked = 0
    for row, column in np.argwhere(grid.inside(living) & (grid.clearance > 0.0)).tolist():
        offset = np.array(grid.point((row, column))) - start
        along = np.clip(np.sum(offset * side, axis=1) / np.sum(side * side, axis=1), 0.0, 1.0)
        nearest = np.hypot(*(offset - along[:, None] * side).T).min()
        assert grid.clearance[row, column] == pytest.approx(min(nearest, 1.0), abs=1e-9)
        checked += 1
    assert checked > 500


def test_routes_are_shortest_and_keep_away() -> None:
    home, _, grid = make_home(rng(2))
    front = transform(home.dock, [DOCK_FRONT, 0.0])
    start = grid.cell(float(front[0]), float(front[1]))
    routes = find_routes(grid, start)
    reached = np.argwhere(np.isfinite(routes.cost))
    farthest = max(((row, column) for row, column in reached.tolist()), key=lambda cell: float(routes.cost[cell]))
    path = trace(grid, routes, farthest)
    assert tuple(path[0]) == grid.point(start)
    assert tuple(path[-1]) == grid.point(farthest)
    assert np.hypot(*np.diff(path, axis=0).T).max() < 0.1415
    assert np.hypot(*np.diff(path, axis=0).T).sum() <= routes.cost[farthest] + 1e-9
    for x, y in smooth(grid, path):
        assert grid.at(x, y) >= NEAREST
    # The condition of shortest paths: no step from one cell to the next betters the cost there.
    weight = 1.0 + DISCOMFORT * np.maximum(0.0, 1.0 - grid.clearance / COMFORT)
    rows, columns = reached[:, 0], reached[:, 1]
    for dr, dc in ((0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (-1, -1), (1, -1), (-1, 1)):
        there = rows + dr, columns + dc
        both = np.isfinite(routes.cost[there])
        price = 0.1 * np.hypot(dr, dc) * weight[there][both]
        assert np.all(routes.cost[there][both] <= routes.cost[rows, columns][both] + price + 1e-9)
