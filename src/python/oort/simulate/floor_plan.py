# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Floor plans: rectangular rooms, the walls between them and the doorways through those walls.

Two kinds of home are made: rooms on both sides of a corridor that leaves a living room, and a rectangle that is split
again and again. All lengths are metres, in the plan's own frame (walls along x and y).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from oort.poses import Array

WALL_THICKNESS = 0.12
ROOMS = (4, 8)  # fewest and most rooms of a home, the corridor counted
AREA = (40.0, 120.0)  # smallest and largest floor area of a home, m^2
NARROWEST_ROOM = 1.9
DOOR_WIDTH = (0.80, 0.95)
OPENING_WIDTH = (1.2, 1.9)
CORNER_TO_DOOR = 0.12
EPSILON = 1e-9


@dataclass(frozen=True)
class Rect:
    """Axis-aligned rectangle."""

    x0: float
    y0: float
    x1: float
    y1: float

    @property
    def width(self) -> float:
        """Extent along x."""
        return self.x1 - self.x0

    @property
    def height(self) -> float:
        """Extent along y."""
        return self.y1 - self.y0

    @property
    def area(self) -> float:
        """Area, m^2."""
        return self.width * self.height

    @property
    def centre(self) -> tuple[float, float]:
        """Middle point."""
        return 0.5 * (self.x0 + self.x1), 0.5 * (self.y0 + self.y1)

    def grown(self, x: float, y: float) -> "Rect":
        """The rectangle with ``x`` and ``y`` added on each side (negative: taken away)."""
        return Rect(self.x0 - x, self.y0 - y, self.x1 + x, self.y1 + y)

    def polygon(self) -> Array:
        """Corners (4, 2), counter-clockwise."""
        return np.array([[self.x0, self.y0], [self.x1, self.y0], [self.x1, self.y1], [self.x0, self.y1]])


@dataclass(frozen=True)
class RoomPlan:
    """A room: what it is for and the rectangle between the faces of its walls."""

    kind: str
    rect: Rect


@dataclass(frozen=True)
class Doorway:
    """A gap in the wall between two rooms; ``wall_along_y`` tells the direction in which that wall runs."""

    rooms: tuple[int, int]
    gap: Rect
    wall_along_y: bool

    @property
    def width(self) -> float:
        """Clear width of the opening."""
        return self.gap.height if self.wall_along_y else self.gap.width


@dataclass(frozen=True)
class FloorPlan:
    """The rooms of a home and the doorways that join them."""

    rooms: tuple[RoomPlan, ...]
    doorways: tuple[Doorway, ...]


def make_floor_plan(rng: np.random.Generator) -> FloorPlan:
    """Draw a floor plan whose rooms are all joined by doorways."""
    while True:
        cells = _corridor_cells(rng) if rng.random() < 0.65 else _split_cells(rng)
        cells = _mirror(cells, rng)
        rooms = [(kind, cell.grown(-0.5 * WALL_THICKNESS, -0.5 * WALL_THICKNESS)) for kind, cell in cells]
        rects = [rect for _, rect in rooms]
        narrow = any(min(r.width, r.height) < NARROWEST_ROOM for kind, r in rooms if kind != "corridor")
        right_size = AREA[0] <= sum(r.area for r in rects) <= AREA[1] and ROOMS[0] <= len(rects) <= ROOMS[1]
        if narrow or not right_size:
            continue
        kinds = _name_rooms([kind for kind, _ in rooms], rects)
        doorways = _cut_doorways(kinds, rects, rng)
        if doorways is not None:
            return FloorPlan(tuple(map(RoomPlan, kinds, rects)), doorways)


def _corridor_cells(rng: np.random.Generator) -> list[tuple[str, Rect]]:
    """A living room at one end, a corridor that leaves it, rooms on both sides of the corridor."""
    below, corridor, above = rng.uniform(2.4, 4.2), rng.uniform(1.2, 1.5), rng.uniform(2.4, 4.2)
    living, length = rng.uniform(3.4, 5.2), rng.uniform(4.4, 9.6)
    height = below + corridor + above
    cells = [("corridor", Rect(living, below, living + length, below + corridor))]
    if rng.random() < 0.5:
        cells.append(("living room", Rect(0.0, 0.0, living, height)))
    else:
        cells.append(("living room", Rect(0.0, 0.0, living, below + corridor)))
        cells.append(("kitchen", Rect(0.0, below + corridor, living, height)))
    for y0, y1 in ((0.0, below), (below + corridor, height)):
        count = int(rng.integers(np.ceil(length / 3.8), int(length / 2.1) + 1))
        shares = rng.uniform(0.7, 1.3, count)
        edges = living + length * np.concatenate([[0.0], np.cumsum(shares) / np.sum(shares)])
        cells += [("", Rect(float(a), y0, float(b), y1)) for a, b in pairwise(edges)]
    if len(cells) > ROOMS[0] + 1 and rng.random() < 0.35:
        cells.pop()  # the far corner does not belong to this home: an L-shaped outline
    return cells


def _split_cells(rng: np.random.Generator) -> list[tuple[str, Rect]]:
    """A rectangle whose largest part is split in two, across its longer side, until there are rooms enough."""
    cells = [Rect(0.0, 0.0, float(rng.uniform(6.4, 12.0)), float(rng.uniform(6.2, 9.6)))]
    count = int(rng.integers(4, 8))
    while len(cells) < count:
        cell = cells.pop(int(np.argmax([c.area for c in cells])))
        share = float(rng.uniform(0.36, 0.64))
        if cell.width >= cell.height:
            x = cell.x0 + share * cell.width
            cells += [Rect(cell.x0, cell.y0, x, cell.y1), Rect(x, cell.y0, cell.x1, cell.y1)]
        else:
            y = cell.y0 + share * cell.height
            cells += [Rect(cell.x0, cell.y0, cell.x1, y), Rect(cell.x0, y, cell.x1, cell.y1)]
    return [("", cell) for cell in cells]


def _mirror(cells: Sequence[tuple[str, Rect]], rng: np.random.Generator) -> list[tuple[str, Rect]]:
    """The plan as it is, or turned over in x, in y or in both."""
    flip_x, flip_y = rng.random(2) < 0.5
    mirrored = []
    for kind, r in cells:
        x0, x1 = (-r.x1, -r.x0) if flip_x else (r.x0, r.x1)
        y0, y1 = (-r.y1, -r.y0) if flip_y else (r.y0, r.y1)
        mirrored.append((kind, Rect(x0, y0, x1, y1)))
    return mirrored


def _name_rooms(kinds: Sequence[str], rects: Sequence[Rect]) -> list[str]:
    """Give each nameless room its use, by size and neighbours."""
    named = list(kinds)

    def nameless() -> list[int]:
        return sorted((i for i, kind in enumerate(named) if not kind), key=lambda i: (rects[i].area, i))

    if "living room" not in named:
        named[nameless()[-1]] = "living room"
    living = named.index("living room")
    if len(nameless()) > 1:
        named[nameless()[0]] = "bathroom"
    if "kitchen" not in named:
        beside = [i for i in nameless() if _shared_wall(rects[living], rects[i]) is not None]
        named[(beside or nameless())[0]] = "kitchen"
    for rank, index in enumerate(reversed(nameless())):
        named[index] = "bedroom" if rank == 0 or rects[index].area > 9.5 else "study"
    return named


def _shared_wall(a: Rect, b: Rect) -> tuple[Rect, bool] | None:
    """The piece of wall that stands between two rooms and whether it runs along y; None when they do not touch."""
    for left, right in ((a, b), (b, a)):
        if abs(right.x0 - left.x1 - WALL_THICKNESS) < EPSILON:
            low, high = max(a.y0, b.y0), min(a.y1, b.y1)
            if high > low:
                return Rect(left.x1, low, right.x0, high), True
        if abs(right.y0 - left.y1 - WALL_THICKNESS) < EPSILON:
            low, high = max(a.x0, b.x0), min(a.x1, b.x1)
            if high > low:
                return Rect(low, left.y1, high, right.y0), False
    return None


def _cut_doorways(kinds: Sequence[str], rects: Sequence[Rect], rng: np.random.Generator) -> tuple[Doorway, ...] | None:
    """Doorways that join all rooms (a spanning tree that prefers the corridor) and up to two more for loops."""
    candidates = []
    for a in range(len(rects)):
        for b in range(a + 1, len(rects)):
            wall = _shared_wall(rects[a], rects[b])
            if wall is None or max(wall[0].width, wall[0].height) < DOOR_WIDTH[1] + 2.0 * CORNER_TO_DOOR:
                continue
            candidates.append((_reluctance({kinds[a], kinds[b]}) + float(rng.random()), a, b, wall))
    group = list(range(len(rects)))
    doorways, spare = [], []
    for _, a, b, wall in sorted(candidates, key=lambda c: c[:3]):
        if group[a] != group[b]:
            group = [group[a] if g == group[b] else g for g in group]
            doorways.append(_cut(kinds, (a, b), wall, rng))
        elif "bathroom" not in (kinds[a], kinds[b]):
            spare.append((a, b, wall))
    if len(set(group)) > 1:
        return None
    for a, b, wall in spare[:2]:
        if rng.random() < 0.6:
            doorways.append(_cut(kinds, (a, b), wall, rng))
    return tuple(doorways)


def _reluctance(pair: set[str]) -> float:
    """How little one wants a door between two kinds of room."""
    if "corridor" in pair:
        return 0.0
    if "bathroom" in pair:
        return 3.0
    return 1.0 if "living room" in pair else 2.0


def _cut(kinds: Sequence[str], rooms: tuple[int, int], wall: tuple[Rect, bool], rng: np.random.Generator) -> Doorway:
    """A door, or now and then a wide opening to the living room, at a random place of the wall."""
    rect, along_y = wall
    low, high = (rect.y0, rect.y1) if along_y else (rect.x0, rect.x1)
    width = float(rng.uniform(*DOOR_WIDTH))
    pair = {kinds[rooms[0]], kinds[rooms[1]]}
    room_for_opening = min(OPENING_WIDTH[1], high - low - 2.0 * CORNER_TO_DOOR)
    if pair in ({"living room", "kitchen"}, {"living room", "corridor"}) and room_for_opening > OPENING_WIDTH[0]:
        width = float(rng.uniform(OPENING_WIDTH[0], room_for_opening)) if rng.random() < 0.6 else width
    start = float(rng.uniform(low + CORNER_TO_DOOR, high - CORNER_TO_DOOR - width))
    if along_y:
        return Doorway(rooms, Rect(rect.x0, start, rect.x1, start + width), True)
    return Doorway(rooms, Rect(start, rect.y0, start + width, rect.y1), False)
