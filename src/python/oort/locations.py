# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Named places of a map: namespaces, prefixes and checks. The poses themselves live in the mapper and move with it."""

import itertools
import uuid
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from oort._core import Mapper
from oort.errors import StateError
from oort.naming import Naming, session_method

Pose = tuple[float, float, float]
"""x [m], y [m], theta [rad]."""


@dataclass(frozen=True)
class _Request:
    """A place that was asked for before the map had a pose to give it."""

    name_space: str
    id: str


class Locations:
    """Create, read and delete named places of one mapper's map.

    A place is known by its namespace and id; creating it again moves it. The namespace ``dock`` is for docks.
    """

    def __init__(self, mapper: Mapper, naming: Naming = session_method) -> None:
        """Serves the places of ``mapper``; ``naming`` is how messages name the calls."""
        self._naming = naming
        self._mapper = mapper
        self._waiting: list[_Request] = []

    def create_here(self, name_space: str, id: str) -> str:
        """Records the sensor's current pose; before the first node exists, as soon as it does.

        Returns the id, which is made up when it was empty.
        """
        request = _Request(name_space, id or self._new_id(name_space))
        if self._mapper.has_pose:
            self._mapper.create_location(request.name_space, request.id, self._mapper.sensor_pose)
        else:
            self._waiting.append(request)
        return request.id

    def create_at(self, name_space: str, id: str, pose: Pose) -> str:
        """Records a given pose of the sensor in the map frame; returns the id, made up when it was empty."""
        id = id or self._new_id(name_space)
        self._mapper.create_location(name_space, id, pose)
        return id

    def create_points(self, name_spaces: Sequence[str], points: Sequence[Sequence[float]], ids: Sequence[str]) -> None:
        """Records points (x, y) of the map frame, all relative to the node that is nearest to their centroid."""
        if not len(name_spaces) == len(points) == len(ids):
            raise StateError(
                f"{self._naming('graph_loc/create_points')}: got {len(name_spaces)} namespaces, {len(points)} points "
                f"and {len(ids)} ids; give one namespace and one id per point"
            )
        if not all(ids):
            raise StateError(f"create_points: point {list(ids).index('')} has an empty id; give each point one")
        keys = Counter(zip(name_spaces, ids, strict=True))
        for (name_space, id), count in keys.items():
            if count > 1:
                raise StateError(f"create_points: {count} points for {name_space!r}/{id!r}; give each an id of its own")
        if points:
            self._mapper.create_points(list(name_spaces), [(float(p[0]), float(p[1])) for p in points], list(ids))

    @property
    def waiting(self) -> list[tuple[str, str]]:
        """(namespace, id) of the places that have no pose yet."""
        return [(request.name_space, request.id) for request in self._waiting]

    def settle(self) -> bool:
        """Gives the waiting places the current pose, if there is one by now; whether that changed anything."""
        if not self._waiting or not self._mapper.has_pose:
            return False
        for request in self._waiting:
            self._mapper.create_location(request.name_space, request.id, self._mapper.sensor_pose)
        self._waiting.clear()
        return True

    def give_up_waiting(self) -> None:
        """Forgets the places that have no pose yet: the drive that they were to be in is over."""
        self._waiting.clear()

    def list_ids(self, name_space: str, use_as_prefix: bool = False) -> list[tuple[str, str]]:
        """All (namespace, id) of a namespace, or of all that begin with it."""
        return [
            (space, id)
            for space, id, *_ in self._mapper.locations
            if space == name_space or (use_as_prefix and space.startswith(name_space))
        ]

    def list_namespaces(self) -> list[str]:
        """Every namespace that holds a place, in the order in which they were made."""
        return list(dict.fromkeys(space for space, *_ in self._mapper.locations))

    def locate(self, name_space: str, id: str) -> Pose:
        """Where a place is now, in the map frame. Raises StateError if it is not known (yet)."""
        if _Request(name_space, id) in self._waiting:
            raise StateError(
                f"location {name_space!r}/{id!r} has no pose yet: mapping has not reached it; ask again later"
            )
        pose = self._mapper.locate(name_space, id)
        if pose is None:
            raise StateError(
                f"no location {name_space!r}/{id!r}; {self._naming('graph_loc/list')} shows the known ones"
            )
        return pose

    def delete(self, name_space: str, id: str) -> bool:
        """Removes a place; whether it was there."""
        waiting = [r for r in self._waiting if r != _Request(name_space, id)]
        was_waiting = len(waiting) < len(self._waiting)
        self._waiting = waiting
        return self._mapper.delete_location(name_space, id) or was_waiting

    def clear(self, name_space: str, use_as_prefix: bool = False) -> list[tuple[str, str]]:
        """Removes the places that list_ids() would give, and returns them; waiting ones are given up."""
        doomed = self.list_ids(name_space, use_as_prefix)
        for space, id in doomed:
            self._mapper.delete_location(space, id)
        self._waiting = [
            r
            for r in self._waiting
            if r.name_space != name_space and not (use_as_prefix and r.name_space.startswith(name_space))
        ]
        return doomed

    def _new_id(self, name_space: str) -> str:
        """An id that no place of the namespace has: the same one for the same calls."""
        taken = {id for space, id, *_ in self._mapper.locations if space == name_space}
        taken.update(r.id for r in self._waiting if r.name_space == name_space)
        ids = (str(uuid.uuid5(uuid.NAMESPACE_OID, f"{name_space}/{number}")) for number in itertools.count())
        return next(id for id in ids if id not in taken)
