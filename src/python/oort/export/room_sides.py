# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The sides of rectangular rooms, on the walls nearest to them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from oort.export.wall_frame import Array, Box, WallFrame

Labels = NDArray[np.int32]
Sides = Sequence["Side"]
"""Of a room: x0, y0, x1, y1."""

# Fitted on the simulated homes 1 to 18 and 200 to 259, and tried on others (docs/export.md).
_SHARED = 0.15  # [m] of a wall along the side of a room that it bounds
_SNAP = 0.12  # [m] that a side is moved to a wall at most
_STRANGERS = 0.03  # share of a room's rectangle that other rooms may take
_LEAST_OWN = 0.15  # share of its rectangle that must be free: homes leave 0.18 of a room passable
_MOST_UNSEEN = 25.0  # [m^2] of a room's rectangle that may not be free; more is no furniture


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


def box_of(sides: Sides) -> Box:
    """The rectangle of a room."""
    left, lower, right, upper = (side.at for side in sides)
    return left, lower, right, upper


def snap(room: int, box: Box, across: Array, up: Array) -> list[Side]:
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
    return _joined(sides)


def with_side(sides: Sides, k: int, at: float) -> list[Side]:
    """A room with a side elsewhere."""
    moved = list(sides)
    moved[k] = replace(moved[k], at=at)
    return _joined(moved)


def takes_rectangle(frame: WallFrame, labels: Labels, sides: Sides) -> bool:
    """Whether a room takes its rectangle: others have no more of it than noise, and furniture hides the rest."""
    x0, y0, x1, y1 = box_of(sides)
    within = labels[frame.cells((x0, y0, x1, y1))]
    room = sides[0].room
    own, strangers = (within == room).mean(), ((within != room) & (within != 0)).mean()
    unseen = (1.0 - own) * (x1 - x0) * (y1 - y0)
    return bool(strangers <= _STRANGERS and own >= _LEAST_OWN and unseen <= _MOST_UNSEEN)


def _joined(sides: Sides) -> list[Side]:
    """Each side from one beside it to the other."""
    x0, y0, x1, y1 = box_of(sides)
    return [replace(side, begin=y0 if side.along_y else x0, end=y1 if side.along_y else x1) for side in sides]
