# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Rooms with their names: places in the namespace "rooms" that lie in them."""

from collections.abc import Iterable
from dataclasses import dataclass

from oort._core import OccupancyGrid
from oort.export.rooms import Room, find_rooms
from oort.export.wall_frame import Array
from oort.recording.types import Pose

ROOMS = "rooms"
"""the namespace"""


@dataclass(frozen=True, eq=False)
class NamedRoom:
    """A room as people talk of it."""

    number: int
    """1 for the largest; of this map as it is now"""
    name: str
    """empty if it has none"""
    room: Room

    @property
    def label(self) -> str:
        """For a floor plan."""
        return f"{self.name or f'room {self.number}'}, {self.room.area:.1f} m²"


def named_rooms(walls: Array, grid: OccupancyGrid, places: Iterable[tuple[str, str, Pose]]) -> list[NamedRoom]:
    """The rooms of a map, the largest first; ``places`` are namespace, id, pose. Raises OortError as find_rooms()."""
    names = [(id_, pose) for space, id_, pose in places if space == ROOMS]
    found = []
    for number, room in enumerate(find_rooms(walls, grid), start=1):
        inside = [id_ for id_, pose in names if room.holds(pose[0], pose[1])]
        found.append(NamedRoom(number, ", ".join(inside), room))
    return found
