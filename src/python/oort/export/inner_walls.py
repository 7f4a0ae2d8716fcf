# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Inner walls of a home, with their doorways closed.

An inner wall shows both of its faces, each seen from its own room, and most inner walls of a home are equally thick;
furniture shows no back. Its line goes on over doorways, from one wall that it meets to the next.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from oort.export.wall_frame import CELL, Array, Box, WallFrame, covered, oriented

ALIGNED = 0.03
"""[m] between pieces of one face"""

# Fitted on the simulated homes 1 to 18 and 200 to 259, and tried on others (docs/export.md).
_OPEN, _WALL, _THROUGH = 0, 1, 2  # cells of a profile along a wall
_THIN, _THICK = 0.07, 0.32  # [m] between the faces of an inner wall; an open door is thinner
_DOORWAY = 2.2  # [m] the widest opening in a wall that still parts two rooms
_SEEN = 0.3  # share of the strip beside a face that must be free
_USUAL = 0.015  # [m] between the thicknesses of inner walls of one kind
_EVIDENCE = 0.8  # [m] of faces back to back; of a wall as thick as most, of its whole line
_STUB = 0.1  # [m] that a wall must go on beyond another on both sides to go through it
_GOES_ON = 0.15  # [m] of wall beyond one that goes through it: less is a doorway of the next room
_FREE_BESIDE = 0.1  # [m] from the faces of a wall to where cells must be free for both to be seen
_INSET = 0.02  # [m] into it, from where on they must not be
_STUBS = 0.3  # [m] of such cells along a line that are a wall
_FACED = 0.2  # share of a wall between two that go through it, with its doorways, of which a face was seen

# Columns of pairs: from, to across the wall; begin, end of both faces; length seen from both sides, and where that is.
_LOW, _HIGH, _BEGIN, _END, _BOTH, _FROM, _TO = range(7)


def inner_walls(across: Array, up: Array, frame: WallFrame) -> tuple[list[tuple[bool, Box]], float]:
    """Whether each runs along y, and its rectangle; then the thickness of most, 0 if unknown.

    From walls along x and along y, (k, 3) as axis_walls() has them.
    """
    faces = {False: across, True: up}
    pairs = {along_y: _pairs(walls, frame, along_y) for along_y, walls in faces.items()}
    usual = _usual_thickness(np.concatenate(list(pairs.values())))
    known = {
        along_y: np.concatenate([found[_are_walls(found, usual)], _stubs(faces[along_y], frame, along_y, usual)])
        for along_y, found in pairs.items()
    }
    closed = [
        (along_y, box)
        for along_y, walls in faces.items()
        for box in _closed(walls, known[along_y], known[not along_y], frame, along_y)
    ]
    return closed, usual


def _pairs(walls: Array, frame: WallFrame, along_y: bool) -> Array:
    """(k, 7) faces back to back, beside each other or with no more than a doorway between."""
    below, above = (frame.free_beside(walls, along_y, side) for side in (-1.0, 1.0))
    found = []
    order = np.argsort(walls[:, 0], kind="stable").tolist()
    for a, k in enumerate(order):
        for m in order[a + 1 :]:
            low, high = float(walls[k, 0]), float(walls[m, 0])
            if high - low > _THICK:
                break
            begin, end = float(max(walls[k, 1], walls[m, 1])), float(min(walls[k, 2], walls[m, 2]))
            back_to_back = below[k] > max(above[k], _SEEN) and above[m] > max(below[m], _SEEN)
            if high - low >= _THIN and end - begin >= -_DOORWAY and back_to_back:
                outer = float(min(walls[k, 1], walls[m, 1])), float(max(walls[k, 2], walls[m, 2]))
                found.append((low, high, *outer, max(0.0, end - begin), min(begin, end), max(begin, end)))
    return np.array(sorted(found)).reshape(-1, 7)


def _usual_thickness(pairs: Array) -> float:
    """[m] of most inner wall that was seen from both sides."""
    if not len(pairs):
        return 0.0
    thickness = pairs[:, _HIGH] - pairs[:, _LOW]
    votes = (np.abs(thickness[:, None] - thickness) <= _USUAL) @ pairs[:, _BOTH]
    return float(np.median(thickness[np.abs(thickness - thickness[votes.argmax()]) <= _USUAL]))


def _are_walls(pairs: Array, usual: float) -> NDArray[np.bool_]:
    """Which pairs are walls: what stands back to back by chance is short, or of another thickness."""
    verdicts = []
    for pair in pairs:
        line = pairs[(np.abs(pairs[:, :2] - pair[:2]) <= ALIGNED).all(axis=1)]
        as_usual = abs(float((line[:, _HIGH] - line[:, _LOW]).mean()) - usual) <= _USUAL
        length = line[:, _END].max() - line[:, _BEGIN].min() if as_usual else line[:, _BOTH].sum()
        verdicts.append(length >= _EVIDENCE)
    return np.array(verdicts, dtype=np.bool_)


def _stubs(walls: Array, frame: WallFrame, along_y: bool, usual: float) -> Array:
    """(k, 7) walls as thick as most of which one face is known, and cells show both beside doorways."""
    free = frame.free.T if along_y else frame.free  # rows across the wall, columns along it
    across, along = frame.low if along_y else frame.low[::-1]
    below, above = (frame.free_beside(walls, along_y, side) for side in (-1.0, 1.0))
    found = []
    for k, (at, begin, end) in enumerate(walls.tolist() if usual else []):
        low, high = (at, at + usual) if below[k] > above[k] else (at - usual, at)
        ends = np.array([low - _FREE_BESIDE, low + _INSET, high - _INSET, high + _FREE_BESIDE])
        rows = np.floor((ends - across) / CELL).astype(int)
        if rows[0] < 0 or rows[3] >= len(free):
            continue
        first, last = np.round((np.array([begin - _DOORWAY, end + _DOORWAY]) - along) / CELL).astype(int).clip(0)
        ribbon = free[rows[0]] & free[rows[3]] & ~free[rows[1] : rows[2] + 1].any(axis=0)
        stubs = float(along) + CELL * (first + np.flatnonzero(ribbon[first:last]))
        if len(stubs) * CELL >= _STUBS:
            middle = float(np.median(stubs))
            found.append((low, high, begin, end, len(stubs) * CELL, middle, middle))
    return np.array(found).reshape(-1, 7)


def _closed(walls: Array, pairs: Array, crossing: Array, frame: WallFrame, along_y: bool) -> list[Box]:
    """Walls along one axis with their doorways closed."""
    free = frame.free.T if along_y else frame.free  # rows across the wall, columns along it
    across, along = frame.low if along_y else frame.low[::-1]
    found = set()
    for pair in pairs:
        low, high = float(pair[_LOW]), float(pair[_HIGH])
        rows = np.round((np.array([low, high]) - across) / CELL).astype(int)
        first_row = min(max(int(rows[0]), 0), len(free) - 1)
        inside = free[first_row : max(int(rows[1]), first_row + 1)]
        profile = np.where(inside.mean(axis=0) > 0.5, _OPEN, _WALL)
        through = crossing[(crossing[:, _BEGIN] <= low - _STUB) & (crossing[:, _END] >= high + _STUB), :2]
        for begin, end in np.round((through - along) / CELL).astype(int).tolist():
            profile[max(begin - 1, 0) : end + 1] = _THROUGH
        faces = walls[(np.abs(walls[:, :1] - [low, high]) <= ALIGNED).any(axis=1), 1:]
        middle = round((0.5 * float(pair[_FROM] + pair[_TO]) - float(along)) / CELL)
        for first, last in _pieces(profile, min(max(middle, 0), len(profile))):
            begin, end = float(along) + CELL * first, float(along) + CELL * last
            if covered(faces, begin, end) >= _FACED * (end - begin):
                found.add(oriented(along_y, low, high, begin, end))
    return sorted(found)


def _pieces(profile: NDArray[np.int64], middle: int) -> list[tuple[int, int]]:
    """The pieces of a wall, from a cell of it both ways: begin, end."""
    count = len(profile)
    onwards = list(_onwards(profile[middle:]))
    backwards = list(_onwards(profile[:middle][::-1]))
    whole = middle - backwards[0][1], middle + onwards[0][1]
    after = [(middle + begin, middle + end) for begin, end in onwards[1:]]
    before = [(middle - end, middle - begin) for begin, end in backwards[1:]]
    return [(begin, end) for begin, end in (*before, whole, *after) if 0 <= begin < end <= count]


def _onwards(profile: NDArray[np.int64]) -> Iterator[tuple[int, int]]:
    """The pieces of a wall from its first cell on, from one wall that goes through it to the next.

    It ends where no wall follows within a doorway, and where what lies beyond a wall that goes through is open.
    """
    doorway, beyond = round(_DOORWAY / CELL), round(_GOES_ON / CELL)
    begin = reached = k = 0
    while k < len(profile):
        if profile[k] == _THROUGH:
            yield begin, k
            while k < len(profile) and profile[k] == _THROUGH:
                k += 1
            begin = reached = k
            if (profile[k : k + beyond] == _OPEN).any():
                return
            continue
        if profile[k] == _WALL:
            reached = k + 1
        elif k - reached > doorway:
            break
        k += 1
    yield begin, reached
