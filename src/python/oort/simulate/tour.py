# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Where a drive goes: places from which all rooms are seen, in a short round trip from the dock and back."""

from dataclasses import dataclass

import numpy as np

from oort.poses import Array
from oort.simulate.floor_plan import FloorPlan
from oort.simulate.free_space import BoolArray, Cell, ClearanceGrid, Routes, find_routes, smooth, trace

VIEW = 1.4  # m; floor within this distance of a visited place counts as seen
UNSEEN = 0.1  # part of a room's floor that may stay unseen
ROOMY = 0.3  # m of clearance at a visited place
CONSIDERED = 0.05  # part of the floor that a roaming robot may choose places from


@dataclass(frozen=True, eq=False)
class Places:
    """The places of a home that a drive visits, with the routes between them. The first is before the dock."""

    grid: ClearanceGrid
    cells: tuple[Cell, ...]
    routes: tuple[Routes, ...]

    def path(self, start: int, goal: int) -> Array:
        """Points (n, 2) of the way from one place to another."""
        return smooth(self.grid, trace(self.grid, self.routes[start], self.cells[goal]))

    def distances(self) -> Array:
        """Cost (n, n) of the way from each place to each other."""
        rows, columns = zip(*self.cells, strict=True)
        return np.array([routes.cost[rows, columns] for routes in self.routes])


def find_places(
    plan: FloorPlan, grid: ClearanceGrid, dock_front: Array, rng: np.random.Generator | None = None
) -> Places:
    """Choose, room by room, few places such that nearly all reachable floor is near one of them.

    With ``rng`` only a random part of the floor is considered, so that each time other places are chosen.
    """
    start = grid.cell(float(dock_front[0]), float(dock_front[1]))
    from_dock = find_routes(grid, start)
    reachable = np.isfinite(from_dock.cost)
    cells = [start]
    for room in plan.rooms:
        stands = grid.clearance >= ROOMY
        if rng is not None:
            stands &= rng.random(stands.shape) < CONSIDERED
        cells += [cell for cell in _cover(grid, reachable & grid.inside(room.rect), stands) if cell != start]
    routes = [from_dock, *(find_routes(grid, cell) for cell in cells[1:])]
    return Places(grid, tuple(cells), tuple(routes))


def _cover(grid: ClearanceGrid, floor: BoolArray, allowed: BoolArray) -> list[Cell]:
    """Greedy cover of a room's floor from allowed places; of those that see as much, the one of most clearance."""
    seen_from = np.argwhere(floor)
    candidates = np.argwhere(floor & allowed)
    if not len(candidates):
        return []
    points = np.array([grid.point((row, column)) for row, column in seen_from.tolist()])
    stands = np.array([grid.point((row, column)) for row, column in candidates.tolist()])
    sees = np.hypot(*(stands[:, None, :] - points[None, :, :]).transpose(2, 0, 1)) <= VIEW
    clearance = grid.clearance[candidates[:, 0], candidates[:, 1]]
    unseen = np.ones(len(points), dtype=bool)
    chosen: list[Cell] = []
    while np.count_nonzero(unseen) > UNSEEN * len(points):
        gain = np.count_nonzero(sees[:, unseen], axis=1)
        if not gain.any():
            break
        best = int(np.argmax(gain * (0.5 + np.minimum(clearance, 1.0))))
        unseen &= ~sees[best]
        chosen.append((int(candidates[best, 0]), int(candidates[best, 1])))
    return chosen


def plan_tour(places: Places, least_length: float, rng: np.random.Generator, roam: bool = False) -> list[int]:
    """Order of places from the dock to the dock: a short round trip, then random places up to a length [m].

    With ``roam`` the round trip, too, is in a random order.
    """
    cost = places.distances()
    if roam:
        tour = [0, *(1 + rng.permutation(len(places.cells) - 1)).tolist(), 0]
    else:
        tour = _two_opt(cost, _nearest_neighbours(cost))
    length = float(cost[tour[:-1], tour[1:]].sum())
    end = tour.pop()
    while length < least_length and len(places.cells) > 2:
        following = int(rng.integers(1, len(places.cells)))
        if following != tour[-1]:
            length += float(cost[tour[-1], following])
            tour.append(following)
    return [*tour, end]


def _nearest_neighbours(cost: Array) -> list[int]:
    tour, left = [0], set(range(1, len(cost)))
    while left:
        following = min(left, key=lambda place: (cost[tour[-1], place], place))
        left.remove(following)
        tour.append(following)
    return [*tour, 0]


def _two_opt(cost: Array, tour: list[int]) -> list[int]:
    """Turn around pieces of the tour as long as that makes it shorter."""
    improved = True
    while improved:
        improved = False
        for i in range(1, len(tour) - 2):
            for j in range(i + 1, len(tour) - 1):
                before = cost[tour[i - 1], tour[i]] + cost[tour[j], tour[j + 1]]
                after = cost[tour[i - 1], tour[j]] + cost[tour[i], tour[j + 1]]
                if after < before - 1e-6:
                    tour[i : j + 1] = tour[i : j + 1][::-1]
                    improved = True
    return tour
