# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Areas and lines where a robot shall not go, kept as places, so that they move with the map.

The corners are the places "0", "1", ... of a namespace "no_go_area/NAME" or "no_go_line/NAME", relative to one node.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from oort._core import Map
from oort.errors import InputError

Point = tuple[float, float]

FEWEST = {"no_go_area": 3, "no_go_line": 2}
"""Points of each kind."""


@dataclass(frozen=True, slots=True)
class Area:
    """A polygon or a line of several points, in the map's frame."""

    kind: str
    """one of FEWEST"""
    name: str
    points: tuple[Point, ...]
    """[m]; a polygon is closed from the last to the first"""

    @property
    def name_space(self) -> str:
        """Of its points."""
        return f"{self.kind}/{self.name}"


def make_area(kind: str, name: str, points: Iterable[Sequence[float]]) -> Area:
    """Raises InputError if there can be no such area."""
    if kind not in FEWEST:
        raise InputError(f"{kind!r} is no kind of area; there are {' and '.join(FEWEST)}")
    corners = tuple((float(x), float(y)) for x, y in points)
    if not name or "\0" in name:
        raise InputError(f"a {kind} needs a name, without NUL characters")
    if len(corners) < FEWEST[kind]:
        raise InputError(f"{name}: a {kind} has at least {FEWEST[kind]} points, not {len(corners)}")
    if not all(math.isfinite(value) for corner in corners for value in corner):
        raise InputError(f"{name}: a point of it is not finite")
    return Area(kind, name, corners)


def is_area(name_space: str) -> bool:
    """Whether places of a namespace are points of an area."""
    return name_space.partition("/")[0] in FEWEST and "/" in name_space


def areas_of(places: Iterable[tuple[str, str, Sequence[float]]]) -> list[Area]:
    """The areas among places: namespace, id, pose. What is too short for its kind is none."""
    corners: dict[str, dict[int, Point]] = {}
    for name_space, id_, pose in places:
        if is_area(name_space) and id_.isdecimal():
            corners.setdefault(name_space, {})[int(id_)] = (float(pose[0]), float(pose[1]))
    areas = []
    for name_space, points in sorted(corners.items()):
        kind, _, name = name_space.partition("/")
        if len(points) >= FEWEST[kind]:
            areas.append(Area(kind, name, tuple(points[number] for number in sorted(points))))
    return areas


def areas_of_map(map_: Map) -> list[Area]:
    """The areas of a map where they are now."""
    found = ((space, id_, map_.locate(space, id_)) for space, id_, *_ in map_.locations)
    return areas_of((space, id_, pose) for space, id_, pose in found if pose is not None)
