# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Pieces of furniture: what a scan at shin height sees of each, and where the robot cannot go because of it.

A piece is described in its own frame: its back lies on y = 0, centred on x = 0, and +y leads away from the wall.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from oort.poses import Array
from oort.simulate.floor_plan import Rect
from oort.simulate.planar import transform

LEG_RADIUS = 0.022
CHAIR = 0.44  # a chair's legs stand on a square of this side


@dataclass(frozen=True, eq=False)
class Piece:
    """Something that stands in a room.

    ``footprint`` (n, 2) is a convex polygon that nobody enters; ``solids`` are the polygons and ``discs`` (k, 3) of
    x, y, radius the round things that a scan sees. Polygons are counter-clockwise.
    """

    name: str
    footprint: Array
    solids: tuple[Array, ...]
    discs: Array

    def moved(self, pose: Sequence[float] | Array) -> "Piece":
        """The piece with its own frame put at ``pose`` (x, y, heading)."""
        centres = transform(pose, self.discs[:, :2])
        return Piece(
            self.name,
            transform(pose, self.footprint),
            tuple(transform(pose, solid) for solid in self.solids),
            np.column_stack([centres, self.discs[:, 2]]),
        )


def overlap(a: Array, b: Array) -> bool:
    """Whether two convex polygons share area (separating axis theorem)."""
    for polygon in (a, b):
        edges = np.roll(polygon, -1, axis=0) - polygon
        normals = np.column_stack([edges[:, 1], -edges[:, 0]])
        of_a, of_b = a @ normals.T, b @ normals.T
        if np.any((of_a.max(axis=0) <= of_b.min(axis=0)) | (of_b.max(axis=0) <= of_a.min(axis=0))):
            return False
    return True


def box(name: str, width: float, depth: float) -> Piece:
    """A closed box that reaches the floor."""
    corners = Rect(-0.5 * width, 0.0, 0.5 * width, depth).polygon()
    return Piece(name, corners, (corners,), np.empty((0, 3)))


def corner_wall(leg: float) -> Piece:
    """A wall across the corner of a room, at 45 degrees, in the corner's own frame (walls along +x and +y)."""
    corners = np.array([[0.0, 0.0], [leg, 0.0], [0.0, leg]])
    return Piece("corner wall", corners, (corners,), np.empty((0, 3)))


def door_leaf(length: float, angle: float, hinge_on_left: bool) -> Piece:
    """A door that stands open at ``angle`` [rad] from closed; its hinge is the origin, the room is on +y."""
    sign = 1.0 if hinge_on_left else -1.0
    corners = transform([0.0, 0.0, angle], Rect(0.02, -0.02, length, 0.02).polygon()) * [sign, 1.0]
    corners = corners if hinge_on_left else corners[::-1]
    return Piece("door leaf", corners, (corners,), np.empty((0, 3)))


def dock(width: float, depth: float) -> Piece:
    """The charging dock."""
    return box("dock", width, depth)


def _round(name: str, radius: float) -> Piece:
    square = Rect(-radius, 0.0, radius, 2.0 * radius).polygon()
    return Piece(name, square, (), np.array([[0.0, radius, radius]]))


def _on_legs(name: str, width: float, depth: float, radius: float = LEG_RADIUS) -> Piece:
    x, y = 0.5 * width - radius, depth - radius
    discs = [[-x, radius, radius], [x, radius, radius], [-x, y, radius], [x, y, radius]]
    return Piece(name, Rect(-0.5 * width, 0.0, 0.5 * width, depth).polygon(), (), np.array(discs))


def _dining_set(rng: np.random.Generator) -> Piece:
    """A table with chairs, not quite straight, along its two long sides."""
    width, depth = float(rng.uniform(1.2, 1.7)), float(rng.uniform(0.75, 0.9))
    table = _on_legs("", width, depth).moved([0.0, 0.3, 0.0])
    discs = [table.discs]
    for side in (-1.0, 1.0):
        for x in (-0.27 * width, 0.27 * width):
            y = 0.3 + 0.5 * depth + side * (0.5 * depth + float(rng.uniform(-0.1, 0.02)))
            chair = _on_legs("", CHAIR, CHAIR, 0.016).moved([0.0, -0.5 * CHAIR, 0.0])
            discs.append(chair.moved([x, y, float(rng.uniform(-0.15, 0.15))]).discs)
    footprint = Rect(-0.5 * width - 0.02, 0.0, 0.5 * width + 0.02, depth + 0.6).polygon()
    return Piece("dining table", footprint, (), np.vstack(discs))


def _office_chair() -> Piece:
    """A column on a five-armed foot, of which a scan sees the column and the castors."""
    angles = 2.0 * np.pi * np.arange(5) / 5.0
    castors = np.column_stack([0.28 * np.cos(angles), 0.28 + 0.28 * np.sin(angles), np.full(5, 0.025)])
    discs = np.vstack([castors, [[0.0, 0.28, 0.03]]])
    return Piece("office chair", Rect(-0.31, -0.03, 0.31, 0.59).polygon(), (), discs)


@dataclass(frozen=True)
class Wish:
    """A piece that a room would like to have: how to make it, how often, and whether it stands at a wall."""

    make: Callable[[np.random.Generator], Piece]
    chance: float = 1.0
    at_wall: bool = True


def _box_wish(
    name: str, width: tuple[float, float], depth: tuple[float, float], chance: float = 1.0, at_wall: bool = True
) -> Wish:
    return Wish(lambda rng: box(name, float(rng.uniform(*width)), float(rng.uniform(*depth))), chance, at_wall)


_PLANT = Wish(lambda rng: _round("plant", float(rng.uniform(0.12, 0.2))), 0.6)
_ARMCHAIR = _box_wish("armchair", (0.75, 0.9), (0.75, 0.9), 0.6, at_wall=False)
_COFFEE_TABLE = Wish(lambda rng: _on_legs("coffee table", float(rng.uniform(0.8, 1.1)), 0.55), 0.8, at_wall=False)
_DESK = Wish(lambda rng: _on_legs("desk", float(rng.uniform(1.2, 1.6)), 0.7, 0.03))

WISHES: dict[str, tuple[Wish, ...]] = {
    "living room": (
        _box_wish("sofa", (1.7, 2.3), (0.85, 0.95)),
        _box_wish("television board", (1.2, 1.8), (0.38, 0.45)),
        _COFFEE_TABLE,
        _box_wish("shelf", (0.8, 1.6), (0.3, 0.4), 0.8),
        _ARMCHAIR,
        _PLANT,
        _box_wish("sideboard", (1.0, 1.5), (0.4, 0.45), 0.5),
    ),
    "kitchen": (
        _box_wish("counter", (1.8, 2.6), (0.6, 0.62)),
        _box_wish("refrigerator", (0.58, 0.62), (0.6, 0.66)),
        Wish(_dining_set, 0.85, at_wall=False),
        _box_wish("cupboard", (0.6, 1.2), (0.4, 0.6), 0.6),
    ),
    "bedroom": (
        _box_wish("bed", (1.4, 1.8), (2.0, 2.1)),
        _box_wish("wardrobe", (1.2, 2.0), (0.58, 0.62)),
        _box_wish("night table", (0.4, 0.45), (0.38, 0.42)),
        _box_wish("chest of drawers", (0.8, 1.1), (0.45, 0.5), 0.5),
        _PLANT,
    ),
    "bathroom": (
        _box_wish("bathtub", (1.5, 1.7), (0.7, 0.75), 0.7),
        _box_wish("toilet", (0.36, 0.4), (0.6, 0.68)),
        _box_wish("washstand", (0.5, 0.7), (0.42, 0.5)),
    ),
    "study": (
        _DESK,
        Wish(lambda rng: _office_chair(), 0.9, at_wall=False),
        _box_wish("bookcase", (0.8, 1.4), (0.28, 0.34)),
        _box_wish("filing cabinet", (0.42, 0.46), (0.5, 0.6), 0.5),
        _PLANT,
    ),
    "corridor": (_box_wish("shoe cabinet", (0.6, 1.0), (0.2, 0.26), 0.6),),
}
