# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The sides of rectangular rooms: on the walls around them, also where furniture hides these.

A side that furniture hides is known from elsewhere: its wall shows its other face to the room behind it, or goes on
along the rooms beside.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from oort.export.inner_walls import ALIGNED
from oort.export.wall_frame import CELL, Array, Box, WallFrame, covered, oriented

Labels = NDArray[np.int32]
Sides = list["Side"]
"""Of a room: x0, y0, x1, y1."""

# Fitted on the simulated homes 1 to 18 and 200 to 259, and tried on others (docs/export.md).
_SHARED = 0.15  # [m] of a wall along the side of a room that it bounds
_SNAP = 0.12  # [m] that a side is moved to a wall at most
_BESIDE = 0.12  # [m] by which rooms may overlap that lie beside each other
_BEHIND = 0.5  # [m] of a side that another room must have behind it
_HIDDEN = 2.2  # [m] that furniture hides at most behind it: a bed
_OTHERS = 0.03  # share of what lies behind a side that may belong to rooms
_ONE_LINE = 0.06  # [m] between the sides of rooms at one wall
_KNOWN = 0.3  # [m] of wall along the side of another room that tells of a line
_UNSEEN = 0.15  # share of a side along which a wall was seen below which any line is better
_HALF_SEEN = 0.5  # the same, for a line that is far off and long; a side seen more is that of furniture or a wall
_LONG = 1.0  # [m] of such a line
_FAR = 0.24  # [m] to such a line; nearer ones are those of rooms behind thin walls
_ROUNDS = 3  # a side that was moved shows where those beside it are


@dataclass(frozen=True)
class Side:
    """A side of a room."""

    room: int
    along_y: bool
    outwards: float
    """-1 or 1"""
    at: float
    begin: float
    end: float
    found: bool
    """whether there is a wall"""


@dataclass(frozen=True)
class _Hint:
    """Where the wall of a side may be."""

    at: float
    known: float
    """[m] of wall that were seen there"""
    where: str
    """from where this is known, along the side; empty if from across it"""


def box_of(sides: Sides) -> Box:
    """The rectangle of a room."""
    left, lower, right, upper = (side.at for side in sides)
    return left, lower, right, upper


def snap(room: int, box: Box, across: Array, up: Array) -> Sides:
    """Each side on the wall nearest to it, if there is one."""
    x0, y0, x1, y1 = box
    sides = []
    for k, at in enumerate(box):
        along_y = k % 2 == 0
        walls, begin, end = (up, y0, y1) if along_y else (across, x0, x1)
        shared = np.minimum(walls[:, 2], end) - np.maximum(walls[:, 1], begin)
        near = walls[(np.abs(walls[:, 0] - at) <= _SNAP) & (shared > _SHARED), 0]
        wall = float(near[np.abs(near - at).argmin()]) if len(near) else at
        sides.append(Side(room, along_y, 1.0 if k >= 2 else -1.0, wall, begin, end, bool(len(near))))
    return sides


class Uncoverer:
    """Moves sides that furniture hides out to their walls, over what nobody has seen."""

    def __init__(self, frame: WallFrame, labels: Labels, across: Array, up: Array, usual: float) -> None:
        """``usual`` is the thickness of inner walls, 0 if none is known."""
        self._frame, self._labels, self._usual = frame, labels, usual
        self._facing = {}
        for along_y, walls in ((False, across), (True, up)):
            inner, outer = (frame.free_beside(walls, along_y, side) for side in (-1.0, 1.0))
            self._facing[along_y, 1.0] = walls[inner > outer]
            self._facing[along_y, -1.0] = walls[outer > inner]

    def move(self, rooms: Sequence[Sides]) -> list[Sides]:
        """The rooms with their sides moved."""
        moved = [list(sides) for sides in rooms]
        for _ in range(_ROUNDS):
            for sides in moved:
                for k in (0, 2, 1, 3):
                    x0, y0, x1, y1 = box_of(sides)
                    begin, end = (y0, y1) if k % 2 == 0 else (x0, x1)
                    side = replace(sides[k], begin=begin, end=end)
                    sides[k] = replace(side, at=self._wall_of(side, [each for room in moved for each in room]))
        return moved

    def _seen(self, side: Side) -> float:
        """[m] of a side along which a wall faces the room."""
        walls = self._facing[side.along_y, side.outwards]
        return covered(walls[np.abs(walls[:, 0] - side.at) <= ALIGNED, 1:], side.begin, side.end)

    def _wall_of(self, side: Side, others: Sides) -> float:
        """Where the wall of a side is: as two of what lies before, after and behind it tell, or one if it is unseen."""
        seen, length = self._seen(side), side.end - side.begin
        hints = [hint for other in others for hint in self._hints(side, other)]
        best = 0.0, 0.0  # [m] of wall known, and the way to it
        for hint in hints:
            line = [each for each in hints if abs(each.at - hint.at) <= _ONE_LINE and each.known > _KNOWN]
            known, beyond = sum(each.known for each in line), side.outwards * (hint.at - side.at)
            certain = len({each.where for each in line} - {""}) > 1
            if seen <= _UNSEEN * length:
                certain |= hint.where == "behind" or (bool(line) and beyond > _SNAP)
            elif seen <= _HALF_SEEN * length and hint.where != "behind":
                certain |= known >= _LONG and beyond > _FAR
            if certain and self._is_hidden(side, hint.at):
                best = max(best, (known, beyond))
        return side.at + side.outwards * best[1]

    def _hints(self, side: Side, other: Side) -> Iterator[_Hint]:
        """What a side of another room tells of where the wall of a side is."""
        behind = other.outwards != side.outwards
        at = other.at - side.outwards * self._usual if behind else other.at
        if other.room == side.room or other.along_y != side.along_y:
            return
        if not CELL < side.outwards * (at - side.at) <= _HIDDEN:
            return
        if not behind:
            before, after = other.end <= side.begin + _BESIDE, other.begin >= side.end - _BESIDE
            yield _Hint(at, self._seen(other), "before" if before else "after" if after else "")
        elif self._usual and min(side.end, other.end) - max(side.begin, other.begin) > _BEHIND:
            yield _Hint(at, self._seen(other), "behind")

    def _is_hidden(self, side: Side, at: float) -> bool:
        low, high = sorted((side.at + side.outwards * CELL, at - side.outwards * CELL))
        box = oriented(side.along_y, low, high, side.begin, side.end)
        return bool((self._labels[self._frame.cells(box)] > 0).mean() <= _OTHERS)
