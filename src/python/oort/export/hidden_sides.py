# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Sides of rooms that furniture hides, known from elsewhere.

Their wall shows its other face to the room behind it, or goes on along the rooms beside.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from oort.export.inner_walls import ALIGNED
from oort.export.room_sides import Labels, Side, Sides, box_of, takes_rectangle, with_side
from oort.export.wall_frame import CELL, Array, Box, WallFrame, covered, oriented

# Fitted on the simulated homes 1 to 18 and 200 to 259, and tried on others (docs/export.md).
_NEAR = 0.12  # [m] to a line to which an unseen side is not moved for its own sake
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
_CLEARLY = 0.1  # [m] of wall by which a claim must be better known than one that contradicts it
_ROUNDS = 3  # a side that was moved shows where those beside it are


@dataclass(frozen=True)
class _Hint:
    """Where the wall of a side may be."""

    at: float
    known: float
    """[m] of wall that were seen there"""
    where: str
    """from where this is known, along the side; empty if from across it"""


@dataclass(frozen=True)
class _Claim:
    """Where a side of a room would be."""

    room: int
    """which, of all"""
    k: int
    """which of its sides"""
    at: float
    known: float
    """[m] of wall that were seen there"""


class Uncoverer:
    """Moves sides that furniture hides out to their walls, over what nobody has seen.

    All claims of a round are made against the same state, and of two that contradict each other the better known one
    stays, or none: neither the order of rooms nor mirroring matters.
    """

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
        moved = list(rooms)
        for _ in range(_ROUNDS):
            claims = self._without_contradictions(moved, self._claims(moved))
            moved = _after(moved, claims)
            if not claims:
                break
        return moved

    def _claims(self, rooms: Sequence[Sides]) -> list[list[_Claim]]:
        """Of each side what it may take, the most likely last."""
        seen = [[self._seen(side) for side in sides] for sides in rooms]
        whole = [box_of(sides) if takes_rectangle(self._frame, self._labels, sides) else None for sides in rooms]
        found = []
        for room, sides in enumerate(rooms):
            others = [other for other in range(len(rooms)) if other != room]
            facts = [fact for other in others for fact in zip(rooms[other], seen[other], strict=True)]
            taken = [box for other in others if (box := whole[other]) is not None]
            for k, side in enumerate(sides):
                hints = [hint for other, known in facts for hint in self._hints(side, other, known)]
                claims = [_Claim(room, k, at, known) for known, at in self._walls(side, seen[room][k], hints)]
                found.append([claim for claim in claims if self._may_be(sides, claim, taken)])
        return found

    def _without_contradictions(self, rooms: Sequence[Sides], claims: Sequence[list[_Claim]]) -> list[_Claim]:
        """Of each side its most likely claim that contradicts no other that is known as well."""
        left = [each for each in claims if each]
        while True:
            likely = [each[-1] for each in left]
            lost = {
                claim
                for group in self._contradictions(rooms, likely)
                for claim in group
                if any(claim.known <= other.known + _CLEARLY for other in group if other is not claim)
            }
            if not lost:
                return likely
            left = [rest for each in left if (rest := each[:-1] if each[-1] in lost else each)]

    def _contradictions(self, rooms: Sequence[Sides], claims: Sequence[_Claim]) -> Iterator[list[_Claim]]:
        """Claims that cannot all be true: of one room, or of two on the same floor."""
        after = _after(rooms, claims)
        own = {room: [claim for claim in claims if claim.room == room] for room in {claim.room for claim in claims}}
        for room, group in own.items():
            if not takes_rectangle(self._frame, self._labels, after[room]):
                yield group
            for other, sides in enumerate(after):
                if other == room or (other in own and other < room):
                    continue
                groups = ((group, sides), (own.get(other, []), after[room]))
                yield [
                    claim
                    for each, against in groups
                    for claim in each
                    if self._reaches(rooms[claim.room][claim.k], after[claim.room][claim.k], box_of(against))
                ]

    def _seen(self, side: Side) -> float:
        """[m] of a side along which a wall faces the room."""
        walls = self._facing[side.along_y, side.outwards]
        return covered(walls[np.abs(walls[:, 0] - side.at) <= ALIGNED, 1:], side.begin, side.end)

    def _walls(self, side: Side, seen: float, hints: Sequence[_Hint]) -> list[tuple[float, float]]:
        """Where the wall of a side may be, the most likely last: as two hints tell, or one if it is unseen.

        With each, how much of it is known [m].
        """
        length = side.end - side.begin
        found = []
        for hint in hints:
            line = [each for each in hints if abs(each.at - hint.at) <= _ONE_LINE and each.known > _KNOWN]
            known, beyond = sum(each.known for each in line), side.outwards * (hint.at - side.at)
            certain = len({each.where for each in line} - {""}) > 1
            if seen <= _UNSEEN * length:
                certain |= hint.where == "behind" or (bool(line) and beyond > _NEAR)
            elif seen <= _HALF_SEEN * length and hint.where != "behind":
                certain |= known >= _LONG and beyond > _FAR
            if certain:
                found.append((round(known, 3), beyond, hint.at))
        return [(known, at) for known, _, at in sorted(found)]

    def _hints(self, side: Side, other: Side, known: float) -> Iterator[_Hint]:
        """What a side of another room tells of where the wall of a side is."""
        behind = other.outwards != side.outwards
        at = other.at - side.outwards * self._usual if behind else other.at
        if other.along_y != side.along_y or not CELL < side.outwards * (at - side.at) <= _HIDDEN:
            return
        if not behind:
            before, after = other.end <= side.begin + _BESIDE, other.begin >= side.end - _BESIDE
            yield _Hint(at, known, "before" if before else "after" if after else "")
        elif self._usual and min(side.end, other.end) - max(side.begin, other.begin) > _BEHIND:
            yield _Hint(at, known, "behind")

    def _may_be(self, sides: Sides, claim: _Claim, taken: Sequence[Box]) -> bool:
        """Whether what is claimed is nobody's."""
        side, after = sides[claim.k], with_side(sides, claim.k, claim.at)
        low, high = sorted((side.at + side.outwards * CELL, claim.at - side.outwards * CELL))
        hidden = self._labels[self._frame.cells(oriented(side.along_y, low, high, side.begin, side.end))]
        if (hidden > 0).mean() > _OTHERS or not takes_rectangle(self._frame, self._labels, after):
            return False
        return not any(self._reaches(side, after[claim.k], box) for box in taken)

    def _reaches(self, side: Side, after: Side, box: Box) -> bool:
        """Whether what a side takes, with the wall behind it, lies in a rectangle."""
        low, high = sorted((side.at, after.at + side.outwards * (self._usual - _ONE_LINE)))
        x0, y0, x1, y1 = oriented(side.along_y, low, high, after.begin + _BESIDE, after.end - _BESIDE)
        return min(x1, box[2]) > max(x0, box[0]) and min(y1, box[3]) > max(y0, box[1])


def _after(rooms: Sequence[Sides], claims: Sequence[_Claim]) -> list[Sides]:
    """The rooms with what is claimed."""
    moved = list(rooms)
    for claim in claims:
        moved[claim.room] = with_side(moved[claim.room], claim.k, claim.at)
    return moved
