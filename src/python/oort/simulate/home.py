# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Made-up homes: a floor plan, furnished so that a robot can still reach every room, with a dock at a wall."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from oort.poses import Array, compose
from oort.simulate import furniture
from oort.simulate.floor_plan import Doorway, FloorPlan, Rect, make_floor_plan
from oort.simulate.free_space import RESOLUTION, ClearanceGrid, flood
from oort.simulate.furniture import Piece, overlap
from oort.simulate.planar import transform

PASSAGE = 0.3  # m of clearance that must be left on a way through every room
KEPT_REACHABLE = 0.9  # part of a room's passable floor that furniture may not cut off
FREE_FLOOR = 0.18  # part of a room's area that furniture leaves passable
DOOR_APPROACH = 0.7  # m on both sides of a doorway where nothing stands
DOCK_SIZE = (0.32, 0.08)  # width, depth
DOCK_TO_BASE = 0.17  # m from the dock's front to the base's centre when docked
DOCK_FRONT = 0.75  # m from the docked base to the place from which the robot backs on
DOOR_ANGLES = (1.6, 2.2)  # rad from closed
TRIES = 15  # places tried for one piece
SHIFT = (0.3, 1.5)  # m that a piece is moved when a home is rearranged


@dataclass(frozen=True, eq=False)
class Room:
    """A room: its kind and the corners (n, 2) of its floor, counter-clockwise."""

    kind: str
    corners: Array

    @property
    def area(self) -> float:
        """Floor area in m^2, furniture included."""
        x, y = (self.corners - self.corners[0]).T
        return 0.5 * abs(float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))))


@dataclass(frozen=True, eq=False)
class Home:
    """A home as a planar scene, counter-clockwise polygons, in one frame.

    ``segments`` (n, 4) of x0, y0, x1, y1 and ``discs`` (k, 3) of x, y, radius are all that a scan can hit apart from
    people: walls, door jambs, the sides of furniture, and round legs. ``dock`` is the pose of the docked base.
    """

    rooms: tuple[Room, ...]
    doorways: tuple[Array, ...]
    pieces: tuple[Piece, ...]
    segments: Array
    discs: Array
    dock: Array

    def moved(self, pose: Array) -> "Home":
        """The home in frame a when it is given in frame b and ``pose`` is T_a_b."""
        ends = transform(pose, self.segments.reshape(-1, 2)).reshape(-1, 4)
        return Home(
            tuple(replace(room, corners=transform(pose, room.corners)) for room in self.rooms),
            tuple(transform(pose, corners) for corners in self.doorways),
            tuple(piece.moved(pose) for piece in self.pieces),
            ends,
            np.column_stack([transform(pose, self.discs[:, :2]), self.discs[:, 2]]),
            compose(pose, self.dock),
        )

    @property
    def area(self) -> float:
        """Floor area of all rooms in m^2, walls left out and furniture included."""
        return sum(room.area for room in self.rooms)


def make_home(rng: np.random.Generator) -> tuple[Home, FloorPlan, ClearanceGrid]:
    """Draw a home in its plan's frame, with its plan and its free space."""
    builder = furnish_home(rng)
    return builder.home(), builder.plan, builder.grid


def furnish_home(rng: np.random.Generator) -> "Furnisher":
    """Draw a home; the furnisher can still move things in it."""
    while True:
        builder = Furnisher(make_floor_plan(rng), rng)
        if builder.place_dock():
            builder.furnish()
            return builder


def wall_segments(plan: FloorPlan) -> Array:
    """The faces of all walls as (n, 4), open where doorways are, and the two jambs of each doorway."""
    segments: list[tuple[float, float, float, float]] = []
    for index, room in enumerate(plan.rooms):
        r = room.rect
        own = [doorway for doorway in plan.doorways if index in doorway.rooms]
        for x in (r.x0, r.x1):
            gaps = [(d.gap.y0, d.gap.y1) for d in own if d.wall_along_y and x in (d.gap.x0, d.gap.x1)]
            segments += [(x, low, x, high) for low, high in _between(r.y0, r.y1, gaps)]
        for y in (r.y0, r.y1):
            gaps = [(d.gap.x0, d.gap.x1) for d in own if not d.wall_along_y and y in (d.gap.y0, d.gap.y1)]
            segments += [(low, y, high, y) for low, high in _between(r.x0, r.x1, gaps)]
    for doorway in plan.doorways:
        g = doorway.gap
        if doorway.wall_along_y:
            segments += [(g.x0, g.y0, g.x1, g.y0), (g.x0, g.y1, g.x1, g.y1)]
        else:
            segments += [(g.x0, g.y0, g.x0, g.y1), (g.x1, g.y0, g.x1, g.y1)]
    return np.array(segments)


def _between(low: float, high: float, gaps: Sequence[tuple[float, float]]) -> Iterator[tuple[float, float]]:
    """What is left of the interval when the gaps are taken out."""
    for gap_low, gap_high in sorted(gaps):
        yield low, gap_low
        low = gap_high
    yield low, high


def _holds(rect: Rect, point: Array) -> bool:
    return bool(rect.x0 <= point[0] <= rect.x1 and rect.y0 <= point[1] <= rect.y1)


def _is_at(leaf: Piece, hinge: Array) -> bool:
    """Whether a door leaf hangs there: its near corners are 2 to 3 cm from the hinge."""
    return bool(np.hypot(*(leaf.footprint - hinge[:2]).T).min() < 0.05)


class Furnisher:
    """Puts pieces into the rooms of a plan, one by one, and keeps every doorway reachable."""

    def __init__(self, plan: FloorPlan, rng: np.random.Generator) -> None:
        """Start with the bare walls of ``plan``."""
        self.plan, self.rng = plan, rng
        self._walls = wall_segments(plan)
        self.grid = self._empty_grid()
        self.pieces: list[Piece] = []
        self._doors: list[tuple[int, Array, float, bool]] = []  # room, hinge, length, whether the hinge is on the left
        self.dock = np.zeros(3)
        self._kept_free = [
            doorway.gap.grown(*((DOOR_APPROACH, 0.0) if doorway.wall_along_y else (0.0, DOOR_APPROACH))).polygon()
            for doorway in plan.doorways
        ]
        self._must_reach: dict[int, list[tuple[float, float]]] = {
            i: [d.gap.centre for d in plan.doorways if i in d.rooms] for i in range(len(plan.rooms))
        }

    def place_dock(self) -> bool:
        """Put the dock at a wall of the living room, not quite straight, with free floor before it."""
        index = [room.kind for room in self.plan.rooms].index("living room")
        for _ in range(10 * TRIES):
            pose = self._at_wall(self.plan.rooms[index].rect, 1.2)
            pose[2] += self.rng.uniform(-0.03, 0.03)
            if self.dock_at(index, pose):
                return True
        return False

    def dock_at(self, index: int, pose: Array) -> bool:
        """Put the dock into a room at ``pose`` (x along the wall, y into the room), if it fits."""
        kept = transform(pose, Rect(-0.5, 0.0, 0.5, 1.5).polygon())
        base = compose(pose, [0.0, DOCK_SIZE[1] + DOCK_TO_BASE, 0.5 * np.pi])
        front = transform(base, [DOCK_FRONT, 0.0])
        if any(overlap(kept, other) for other in self._kept_free):
            return False
        self._must_reach[index].append((float(front[0]), float(front[1])))
        if self._try(index, furniture.dock(*DOCK_SIZE).moved(pose)):
            self._kept_free.append(kept)
            self.dock = base
            return True
        self._must_reach[index].pop()
        return False

    def furnish(self) -> None:
        """Open doors, an odd corner here and there, and each room's usual furniture as far as it fits."""
        for doorway in self.plan.doorways:
            if doorway.width < 1.0 and self.rng.random() < 0.5:
                self._hang_door(doorway)
        for index, room in enumerate(self.plan.rooms):
            if room.kind != "corridor" and self.rng.random() < 0.25:
                self._wall_off_corner(index)
            self.furnish_room(index)

    def furnish_room(self, index: int) -> None:
        """A room's usual furniture as far as it fits."""
        for wish in furniture.WISHES[self.plan.rooms[index].kind]:
            if self.rng.random() < wish.chance:
                self._place(index, wish)

    def rearrange(self, count: int, rng: np.random.Generator) -> None:
        """Shift up to ``count`` pieces of furniture, chosen at random, along a wall by 0.3 m to 1.5 m, where they fit.

        The dock, doors and corners stay, and every room stays reachable.
        """
        movable = [piece for piece in self.pieces if piece.name not in ("dock", "door leaf", "corner wall")]
        for number in rng.permutation(len(movable))[:count]:
            self._shift(movable[int(number)], rng)

    def swing_doors(self, rng: np.random.Generator) -> None:
        """Let each door stand open at another angle, where nothing is in its way."""
        for index, hinge, length, hinge_on_left in self._doors:
            angle = float(rng.uniform(*DOOR_ANGLES))
            old = next((p for p in self.pieces if p.name == "door leaf" and _is_at(p, hinge)), None)
            if old is not None:
                self._replace(index, old, [furniture.door_leaf(length, angle, hinge_on_left).moved(hinge)])

    def put(self, piece: Piece) -> None:
        """Put a piece where it is, whatever it blocks."""
        self.grid.block_polygon(piece.footprint)
        self.pieces.append(piece)

    def home(self) -> Home:
        """The home as it is furnished so far."""
        sides = [np.hstack([solid, np.roll(solid, -1, axis=0)]) for piece in self.pieces for solid in piece.solids]
        return Home(
            tuple(Room(room.kind, room.rect.polygon()) for room in self.plan.rooms),
            tuple(doorway.gap.polygon() for doorway in self.plan.doorways),
            tuple(self.pieces),
            np.vstack([self._walls, *sides]),
            np.vstack([piece.discs for piece in self.pieces]),
            self.dock,
        )

    def _shift(self, piece: Piece, rng: np.random.Generator) -> None:
        """Take a piece away and put it down elsewhere in its room, or back."""
        centre = piece.footprint.mean(axis=0)
        index = next(i for i, room in enumerate(self.plan.rooms) if _holds(room.rect, centre))

        def shifted() -> Iterator[Piece]:
            for _ in range(TRIES):
                shift = [0.0, 0.0, 0.0]
                shift[int(rng.integers(2))] = float(rng.choice([-1.0, 1.0]) * rng.uniform(*SHIFT))
                yield piece.moved(shift)

        self._replace(index, piece, shifted())

    def _replace(self, index: int, piece: Piece, tries: Iterable[Piece]) -> None:
        """Take a piece away and put down the first of ``tries`` that fits in its room, or the piece again."""
        others = [other for other in self.pieces if other is not piece]
        self.grid = self._empty_grid()
        self.pieces = []
        for other in others:
            self.put(other)
        if not any(self._try(index, other) for other in tries):
            self.put(piece)

    def _empty_grid(self) -> ClearanceGrid:
        rects = [room.rect for room in self.plan.rooms]
        bounds = Rect(
            min(r.x0 for r in rects), min(r.y0 for r in rects), max(r.x1 for r in rects), max(r.y1 for r in rects)
        )
        grid = ClearanceGrid(bounds.grown(0.3, 0.3))
        for rect in [*rects, *(doorway.gap for doorway in self.plan.doorways)]:
            grid.open_rect(rect)
        grid.block_segments(self._walls)
        return grid

    def _place(self, index: int, wish: furniture.Wish) -> None:
        piece = wish.make(self.rng)
        rect = self.plan.rooms[index].rect
        for _ in range(TRIES):
            if wish.at_wall:
                width = float(np.ptp(piece.footprint[:, 0]))
                pose = self._at_wall(rect, width)
            else:
                heading = self.rng.integers(4) * 0.5 * np.pi + self.rng.normal(0.0, 0.2)
                pose = np.array([self.rng.uniform(rect.x0, rect.x1), self.rng.uniform(rect.y0, rect.y1), heading])
            if self._try(index, piece.moved(pose)):
                return

    def _at_wall(self, rect: Rect, width: float) -> Array:
        """A pose at one of the four walls, x along the wall, y into the room; often in a corner."""
        side = int(self.rng.integers(4))
        length = rect.width if side in (0, 2) else rect.height
        slack = max(0.0, length - width - 0.02)
        share = float(self.rng.choice([0.0, 1.0, self.rng.random()], p=[0.25, 0.25, 0.5]))
        along = 0.01 + 0.5 * width + share * slack
        back = float(self.rng.uniform(0.005, 0.03))
        corner = rect.polygon()[side]
        return compose([corner[0], corner[1], side * 0.5 * np.pi], [along, back, 0.0])

    def _hang_door(self, doorway: Doorway) -> None:
        """Let the door of a doorway stand open in one of its two rooms."""
        index = doorway.rooms[int(self.rng.integers(2))]
        rect, gap = self.plan.rooms[index].rect, doorway.gap
        sides = [gap.y1 <= rect.y0, gap.x0 >= rect.x1, gap.y0 >= rect.y1, gap.x1 <= rect.x0]
        # Seen from the room's side, with x along the wall and y into the room.
        corner = gap.polygon()[(sides.index(True) + 3) % 4]
        frame = np.array([corner[0], corner[1], sides.index(True) * 0.5 * np.pi])
        hinge_on_left = bool(self.rng.random() < 0.5)
        offset = -0.03 if hinge_on_left else doorway.width + 0.03
        length, hinge = doorway.width - 0.03, compose(frame, [offset, 0.005, 0.0])
        leaf = furniture.door_leaf(length, float(self.rng.uniform(*DOOR_ANGLES)), hinge_on_left)
        if self._try(index, leaf.moved(hinge)):
            self._doors.append((index, hinge, length, hinge_on_left))

    def _wall_off_corner(self, index: int) -> None:
        corner = int(self.rng.integers(4))
        point = self.plan.rooms[index].rect.polygon()[corner]
        piece = furniture.corner_wall(float(self.rng.uniform(0.5, 1.0)))
        self._try(index, piece.moved([point[0], point[1], corner * 0.5 * np.pi]))

    def _try(self, index: int, piece: Piece) -> bool:
        """Put a piece into a room if it fits, blocks no doorway and cuts off no floor; otherwise change nothing."""
        rect = self.plan.rooms[index].rect.grown(1e-6, 1e-6)
        low, high = piece.footprint.min(axis=0), piece.footprint.max(axis=0)
        if low[0] < rect.x0 or low[1] < rect.y0 or high[0] > rect.x1 or high[1] > rect.y1:
            return False
        taken = [*self._kept_free, *(other.footprint for other in self.pieces)]
        if any(overlap(piece.footprint, other) for other in taken):
            return False
        before = self.grid.clearance.copy()
        self.grid.block_polygon(piece.footprint)
        if self._is_whole(index):
            self.pieces.append(piece)
            return True
        self.grid.clearance[:] = before
        return False

    def _is_whole(self, index: int) -> bool:
        """Whether a room keeps floor enough, and that and the places to reach in it hang together."""
        window = self.grid.window(self.plan.rooms[index].rect.grown(0.2, 0.2))
        passable = self.grid.clearance[window] >= PASSAGE
        places = [self.grid.cell(x, y) for x, y in self._must_reach[index]]
        places = [(row - window[0].start, column - window[1].start) for row, column in places]
        reached = flood(passable, places[0])
        count = np.count_nonzero(reached)
        kept = count >= KEPT_REACHABLE * np.count_nonzero(passable)
        roomy = count * RESOLUTION**2 >= FREE_FLOOR * self.plan.rooms[index].rect.area
        return bool(kept and roomy and all(reached[place] for place in places))
