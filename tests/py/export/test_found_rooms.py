# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Rooms of painted homes: walls 0.12 m thick, free rectangles, and what furniture hides."""

from collections.abc import Sequence
from itertools import combinations, pairwise
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from shapely.geometry import Polygon

from oort._core import OccupancyGrid
from oort.export.hidden_sides import Uncoverer
from oort.export.room_sides import Sides
from oort.export.rooms import find_rooms

_RESOLUTION = 0.05
_SIZE = 240  # cells each way
_LOW = -1.0  # [m] the grid's corner, both ways

Box = tuple[float, float, float, float]
Home = tuple[list[Box], list[Box]]
"""What is free, and the walls."""


def _grid(free: list[Box]) -> OccupancyGrid:
    """A map with free rectangles x0, y0, x1, y1 and nothing known elsewhere."""
    cells = np.full((_SIZE, _SIZE), -1, dtype=np.int8)
    for box in free:
        scaled = (np.array(box) - _LOW) / _RESOLUTION
        (x0, y0), (x1, y1) = np.ceil(scaled[:2] - 1e-6).astype(int), np.floor(scaled[2:] + 1e-6).astype(int)
        cells[y0:y1, x0:x1] = 0
    grid = SimpleNamespace(cells=cells, width=_SIZE, height=_SIZE, resolution=_RESOLUTION, origin=(_LOW, _LOW))
    return cast(OccupancyGrid, grid)


def _areas(free: list[Box], walls: list[Box]) -> list[float]:
    return [room.area for room in find_rooms(np.array(walls), _grid(free))]


def _sides(x0: float, y0: float, x1: float, y1: float) -> list[Box]:
    """The four walls of a room, seen from within."""
    return [(x0, y0, x1, y0), (x1, y0, x1, y1), (x0, y1, x1, y1), (x0, y0, x0, y1)]


def _column(*rights: float) -> Home:
    """Rooms of 4 m by 2.88 m above each other, a door between any two; where free space ends on the right of each."""
    free: list[Box] = []
    walls: list[Box] = []
    for k, right in enumerate(rights):
        low = 3.0 * k
        free.append((0.0, low, right, low + 2.88))
        walls += _sides(0.0, low, right, low + 2.88)
        if k:
            free.append((1.0, low - 0.2, 1.8, low + 0.1))
    return free, walls


def _facing(left: float, right: float, seen: tuple[bool, bool]) -> Home:
    """Two rooms 2.88 m high with nothing known from x = left to right, and which of them sees a wall there.

    Below and above two rooms each meet at a wall of 0.12 m whose left face is at x = 4 below, at 4.6 above.
    """
    free: list[Box] = []
    walls: list[Box] = []
    for low, wall in ((0.0, 4.0), (6.0, 4.6)):
        for x0, x1 in ((0.0, wall), (wall + 0.12, 9.0)):
            free.append((x0, low, x1, low + 2.88))
            walls += _sides(x0, low, x1, low + 2.88)
    for (x0, x1), is_seen, hidden in zip(((0.0, left), (right, 9.0)), seen, (left, right), strict=True):
        free.append((x0, 3.0, x1, 5.88))
        walls += [side for side in _sides(x0, 3.0, x1, 5.88) if is_seen or not side[0] == side[2] == hidden]
    return free, walls


def _between(home: Home) -> list[float]:
    """Where the left of these two rooms ends, and the right one begins."""
    corners = [room.outline for room in find_rooms(np.array(home[1]), _grid(home[0]))]
    left, right = sorted((each for each in corners if 2.5 < each[:, 1].min() < 3.5), key=lambda each: each[:, 0].min())
    return [float(left[:, 0].max()), float(right[:, 0].min())]


def _mirrored(home: Home) -> Home:
    free, walls = ([(10.0 - x1, y0, 10.0 - x0, y1) for x0, y0, x1, y1 in boxes] for boxes in home)
    return free, walls


def _wardrobes(seed: int) -> Home:
    """Nine rooms whose sides are hidden at random."""
    random = np.random.default_rng(seed)
    free: list[Box] = []
    walls: list[Box] = []
    for x0, x1 in pairwise((0.0, 3.2, 6.0, 9.0)):
        lows = [0.0, *np.cumsum(random.choice([2.5, 2.9, 3.3], 3)).tolist()]
        for y0, y1 in pairwise(lows):
            hidden = random.choice([0.0, 0.0, 0.5, 0.8], 4).tolist()
            box = (x0 + hidden[0], y0 + hidden[1], x1 - 0.15 - hidden[2], y1 - 0.15 - hidden[3])
            free.append(box)
            walls += [side for side in _sides(*box) if random.random() < 0.7]
    return free, walls


def test_rooms_end_at_their_walls() -> None:
    assert _areas(*_column(4.0, 4.0)) == pytest.approx([11.52, 11.52], rel=0.01)


@pytest.mark.parametrize(("first", "found"), [(0.4, 2), (0.0, 1)])
def test_a_wall_between_furniture_shows_beside_its_door(first: float, found: int) -> None:
    """Of a wall at x = 4 one room sees what two cupboards leave of it, too short for a line; the other room all."""
    free: list[Box] = [(0.0, 0.0, 3.4, 4.0), (3.4, 1.5 - first, 4.0, 2.5), (3.9, 1.5, 4.3, 2.5), (4.12, 0.0, 8.0, 4.0)]
    walls: list[Box] = [
        (4.12, 0.0, 4.12, 1.5),
        (4.12, 2.5, 4.12, 4.0),
        (3.4, 0.0, 3.4, 1.5 - first),
        (3.4, 2.5, 3.4, 4.0),
    ]
    walls += [(0.0, 0.0, 3.4, 0.0), (0.0, 4.0, 3.4, 4.0), (0.0, 0.0, 0.0, 4.0)]
    walls += [(4.12, 0.0, 8.0, 0.0), (4.12, 4.0, 8.0, 4.0), (8.0, 0.0, 8.0, 4.0)]
    free += [(0.0, 4.12, 8.0, 7.0)]  # tells how thick walls are
    walls += _sides(0.0, 4.12, 8.0, 7.0)
    assert len(_areas(free, walls)) == 1 + found


def test_a_side_behind_a_wardrobe_is_where_the_rooms_beside_have_it() -> None:
    assert _areas(*_column(4.0, 3.4, 4.0)) == pytest.approx([11.52] * 3, rel=0.01)


def test_one_room_beside_does_not_move_a_side_that_was_seen() -> None:
    assert _areas(*_column(4.0, 3.4)) == pytest.approx([11.52, 3.4 * 2.88], rel=0.01)


def test_one_room_beside_moves_a_side_that_was_not_seen() -> None:
    free, walls = _column(4.0, 3.4)
    walls.remove((3.4, 3.0, 3.4, 5.88))
    assert _areas(free, walls) == pytest.approx([11.52, 11.52], rel=0.01)


def test_a_side_that_was_not_seen_is_where_the_room_behind_has_its_wall() -> None:
    free, walls = _column(4.0, 3.6)
    walls.remove((3.6, 3.0, 3.6, 5.88))
    free.append((4.32, 3.0, 6.0, 5.88))  # its wall lies 0.2 m farther out than that of the room below
    walls += _sides(4.32, 3.0, 6.0, 5.88)
    areas = _areas(free, walls)
    assert areas == pytest.approx([4.2 * 2.88, 11.52, 1.68 * 2.88], rel=0.02)


def test_a_line_is_not_followed_across_another_room() -> None:
    free, walls = _column(4.0, 2.5)
    walls.remove((2.5, 3.0, 2.5, 5.88))
    free.append((2.9, 3.1, 3.9, 5.8))
    walls.append((2.9, 3.1, 2.9, 5.8))
    assert _areas(free, walls)[1] == pytest.approx(2.78 * 2.88, rel=0.01)  # to the back of that room's wall


def test_of_two_lines_that_agree_a_mirrored_home_has_the_same() -> None:
    home = _column(4.0, 3.4, 4.05)
    assert _areas(*_mirrored(home)) == pytest.approx(_areas(*home), rel=0.005)


@pytest.mark.parametrize("seen", [(True, False), (False, True)])
def test_a_wall_that_one_room_sees_is_where_it_sees_it(seen: tuple[bool, bool]) -> None:
    expected = [3.6, 3.72] if seen[0] else [4.78, 4.9]
    home = _facing(3.6, 4.9, seen)
    assert _between(home) == pytest.approx(expected, abs=0.03)
    assert _between(_mirrored(home)) == pytest.approx([10.0 - at for at in reversed(expected)], abs=0.03)


@pytest.mark.parametrize("hidden", [(3.6, 4.9), (3.2, 5.1), (2.5, 6.5), (3.8, 4.3)])
def test_two_rooms_do_not_claim_the_same_floor(hidden: tuple[float, float]) -> None:
    """Their walls go on along two lines; each alone would take the farther one, across the other."""
    home = _facing(*hidden, seen=(False, False))
    left, right = _between(home)
    assert hidden[0] < left <= right - 0.11
    assert right < hidden[1]
    assert _between(_mirrored(home)) == pytest.approx([10.0 - right, 10.0 - left], abs=0.01)


def test_rooms_in_another_order_have_the_same_sides(monkeypatch: pytest.MonkeyPatch) -> None:
    class Reversed(Uncoverer):
        def move(self, rooms: Sequence[Sides]) -> list[Sides]:
            return super().move(rooms[::-1])[::-1]

    homes = [_wardrobes(seed) for seed in range(30)]
    areas = [_areas(*home) for home in homes]
    monkeypatch.setattr("oort.export.rooms.Uncoverer", Reversed)
    assert [_areas(*home) for home in homes] == areas


def test_rooms_behind_furniture_have_floors_of_their_own() -> None:
    for seed in range(30):
        free, walls = _wardrobes(seed)
        rooms = [Polygon(room.outline) for room in find_rooms(np.array(walls), _grid(free))]
        shared = [one.intersection(other).area for one, other in combinations(rooms, 2)]
        assert max(shared) < 0.15, seed
