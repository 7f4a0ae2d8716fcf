# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""One robot's mapping session: the states, what each call does in them, and the saving.

Replay, the ROS node and Python programs drive the same Session; only where the events come from differs.
"""

import enum
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from oort._core import Map, Parameters, Saved, ScanResult, normalise_map_path, save_map, save_metadata
from oort.areas import Area
from oort.diagnosis import Observer, Trouble, diagnose, loose_parts
from oort.errors import StateError
from oort.inputs import quoted
from oort.locations import Locations, Pose
from oort.mapper import Mapper
from oort.naming import METHODS, Naming, session_method
from oort.poses import between, compose
from oort.recording import Scan
from oort.saved_maps import open_map

_FAR = 100.0  # [m] from all that was mapped: no robot was carried there, the pose is wrong


class State(enum.Enum):
    """What map/state answers."""

    NOT_MAPPING = "not_mapping"
    MAPPING = "mapping"
    PAUSED = "paused"


Save = Callable[[str, Map, Saved], object]
"""Writes a map, or only its places, to a path."""


Prepare = Callable[[str, str], object]
"""Hears of a call, and of the path that it gives the map, before it takes effect; raises MapFileError to refuse."""


def save(path: str, map_: Map, what: Saved) -> Saved:
    """Writes a map, or only its places where the rest on disk fits them; what was written. Raises MapFileError."""
    if what is Saved.METADATA:
        return save_metadata(path, map_)
    save_map(path, map_)
    return Saved.MAP


class Session:
    """Takes scans and calls one at a time, in order."""

    def __init__(
        self,
        parameters: Parameters,
        sensor_on_base: Pose = (0.0, 0.0, 0.0),
        *,
        save: Save = save,
        prepare: Prepare = lambda call, path: None,
        naming: Naming = session_method,
        keep_attempts: int = 0,
    ) -> None:
        """Starts empty and not mapping; ``sensor_on_base`` is T_base_sensor.

        ``save`` is how maps reach the disk; ``prepare`` makes a path of start() or resume() ready for that. ``naming``
        is how messages name the calls.
        ``keep_attempts``: of how many attempts to close loops the mapper tells, the latest.
        """
        self._naming = naming
        self._keep_attempts = keep_attempts
        self._parameters = parameters
        self._sensor_on_base = sensor_on_base
        self._save = save
        self._prepare = prepare
        self._state = State.NOT_MAPPING
        self._path = ""
        self._before: Map | None = None  # what this session went on with, until it is accepted
        self._use(self._new_mapper())
        self._calls: dict[str, Callable[..., Any]] = {call: getattr(self, name) for call, name in METHODS.items()}

    # ---- what is there ----

    @property
    def state(self) -> State:
        """The current state."""
        return self._state

    @property
    def path(self) -> str:
        """Where the map is saved; empty for nowhere."""
        return self._path

    @property
    def mapper(self) -> Mapper:
        """The owner of the map."""
        return self._mapper

    @property
    def sensor_on_base(self) -> Pose:
        """T_base_sensor."""
        return self._sensor_on_base

    @property
    def made_odometry(self) -> Pose | None:
        """T_odom_base at the latest scan where the mapper makes it itself (use_odometry is off), else None."""
        if self._parameters.get("use_odometry") or not self._mapper.has_pose:
            return None
        base = compose(self._mapper.sensor_pose, between(self._sensor_on_base, (0.0, 0.0, 0.0)))
        x, y, theta = between(self._mapper.odom_pose, base).tolist()
        return x, y, theta

    @property
    def locations(self) -> Locations:
        """The named places of the map."""
        return self._locations

    @property
    def map(self) -> Map:
        """A snapshot of the map."""
        return self._mapper.map()

    # ---- events ----

    def call(self, name: str, args: Sequence[Any] = ()) -> Any:
        """Makes a call by its name in an events file, such as ``map/notify_docked``.

        Raises StateError for an unknown name, wrong arguments, or a call that the state does not allow.
        """
        if name not in self._calls:
            raise StateError(f"no call {quoted(name)}; the calls are: {', '.join(sorted(self._calls))}")
        try:
            return self._calls[name](*args)
        except (TypeError, ValueError, IndexError) as error:
            why = (str(error) or repr(error)).splitlines()[0][:200]
            raise StateError(f"{name}: the arguments {quoted(list(args))} do not fit: {why}") from error

    def add_scan(self, scan: Scan) -> ScanResult | None:
        """Takes one scan with its odometry; None if the state is not mapping, or it joins the main laser's next."""
        if self._state is not State.MAPPING:
            return None
        if scan.mount is not None:
            self._mapper.add_scan_of_other(scan, scan.odometry, scan.mount)
            return None
        result = self._mapper.add_scan(scan, scan.odometry)
        if self._locations.settle():
            self._write(Saved.METADATA)
        return result

    def observe(self, scan: Scan) -> None:
        """Looks at a scan that was mapped once more, for troubles(): apart from add_scan(), which a robot waits for."""
        if scan.mount is None:
            self._observer.add(scan)

    def troubles(self) -> list[Trouble]:
        """What the scans that were observed, and their mapping, show to be wrong with the setup or the recording."""
        return [*diagnose(self._observer, self._mapper.statistics), *loose_parts(self.map)]

    # ---- map calls ----

    def start(self, path: str = "") -> None:
        """Begins a map, or goes on after a pause; ``path`` is where it is saved, empty for nowhere."""
        _check_text(path=path)
        if self._state is State.NOT_MAPPING and self._mapper.num_nodes > 0:
            raise StateError(
                f"{self._naming('map/start')}: there is a map already; call {self._naming('map/clear')} first, or "
                f"{self._naming('map/resume')} to go on with it"
            )
        if path and not self._is_own(path):
            self._prepare("map/start", path)
        if self._state is State.PAUSED:
            self.resume_from_paused()
        self._state = State.MAPPING
        self._path = path

    def mount_sensor(self, sensor_on_base: Pose) -> None:
        """Says where the sensor sits on the base (T_base_sensor). Raises StateError once scans are being mapped."""
        self._mapper.mount_sensor(sensor_on_base)
        self._sensor_on_base = sensor_on_base
        self._observer = Observer(sensor_on_base)

    def save_to(self, path: str) -> None:
        """Sets where the map is saved from now on; empty for nowhere."""
        self._path = path

    def save(self) -> None:
        """Saves the map as it is, if there is a map and a path."""
        self._write(Saved.MAP)

    def load(self, path: str, *, ignore_checksum: bool = False) -> None:
        """Replaces the map by one from disk; what is in memory stays if that fails."""
        _check_text(path=path)
        mapper = self._new_mapper()
        mapper.set_map(open_map(path, ignore_checksum=ignore_checksum))
        self._use(mapper)
        self._state = State.NOT_MAPPING
        self._path = path

    def resume(self, path: str, pose: Pose) -> None:
        """Goes on with the loaded map in a new segment; ``pose`` is about where the sensor is in the map frame.

        A map that shows most of its places more often than keep_views asks for is pruned first: Mapper.take_renumbering
        tells what became of its nodes.
        """
        resume = self._naming("map/resume")
        if self._state is not State.NOT_MAPPING:
            raise StateError(f"{resume}: the state is {self._state.value}; call {self._naming('map/stop')} first")
        if self._mapper.num_nodes == 0:
            raise StateError(f"{resume}: no map is loaded; call {self._naming('map/load')} first")
        _check_text(path=path)
        if path and self._is_own(path):
            raise StateError(f"{resume}: {path} is the map to go on with, which stays as it is; give another path")
        x, y, theta = (float(value) for value in pose)
        distance = np.hypot(*(self.map.node_poses[:, :2] - (x, y)).T).min()
        if distance > _FAR:
            raise StateError(
                f"{resume}: ({x:g}, {y:g}) is {distance:.0f} m from the map; give the sensor's pose in the map frame"
            )
        if path:
            self._prepare("map/resume", path)
        self._before = self.map
        self._mapper.begin_session((x, y, theta))
        self._path = path
        self._state = State.MAPPING

    def notify_docked(self) -> None:
        """Says that the robot stands at the dock it saw earlier.

        It is linked to the dock beside the scans to come, at the latest when mapping stops; the mapper's
        dock_closure_found tells what came of it.
        """
        docked = self._naming("map/notify_docked")
        if self._state is not State.MAPPING:
            raise StateError(f"{docked}: the state is {self._state.value}; it needs mapping")
        if not self._mapper.has_pose:
            raise StateError(
                f"{docked}: no scan has been mapped yet, so there is nothing to link; drive and scan first"
            )
        self._mapper.request_dock_closure()

    def pause(self) -> None:
        """Stops taking scans until resume_from_paused or start."""
        if self._state is State.NOT_MAPPING:
            pause, start = self._naming("map/pause"), self._naming("map/start")
            raise StateError(f"{pause}: nothing is being mapped; call {start} first")
        self._state = State.PAUSED

    def resume_from_paused(self) -> None:
        """Takes scans again; the link across the pause is very uncertain."""
        if self._state is State.NOT_MAPPING:
            resume, start = self._naming("map/resume_from_paused"), self._naming("map/start")
            raise StateError(f"{resume}: mapping is not paused; call {start} first")
        if self._state is State.PAUSED:
            self._mapper.resume_from_paused()
            self._observer.pause()
            self._state = State.MAPPING

    def stop(self) -> None:
        """Ends mapping with a last solve, and saves the map if there is a path. Places without a pose are given up."""
        try:
            if self._state is not State.NOT_MAPPING:
                self._state = State.NOT_MAPPING
                self._locations.give_up_waiting()
                self._mapper.finish()
        finally:
            self._write(Saved.MAP)  # what there is, even where it cannot be solved

    def accept(self) -> None:
        """Keeps what the session made of the map that it went on with, for good: reject() has nothing to go back to."""
        self._map_before("map/accept")
        self._before = None

    def reject(self) -> None:
        """Brings back the map that the session went on with, its places too, in memory and where the map is saved.

        Possible from resume() on, also after stop(), until accept(), load(), clear() or the next resume(). Where maps
        are kept beside a path, the rejected one is.
        """
        before = self._map_before("map/reject")
        mapper = self._new_mapper()
        mapper.set_map(before)
        if self._path:
            self._write(Saved.MAP)
            self._prepare("map/reject", self._path)
        self._use(mapper)
        self._state = State.NOT_MAPPING
        self._write(Saved.MAP)

    def clear(self) -> None:
        """Drops the map and all places."""
        self._use(self._new_mapper())
        self._state = State.NOT_MAPPING
        self._path = ""

    # ---- location calls ----

    def create_location(self, name_space: str, id: str, pose: Pose | None = None) -> str:
        """Records where the sensor is now under a name; returns the id.

        While mapping the map knows where that is; otherwise ``pose`` is T_map_sensor of a localiser.
        """
        _check_text(namespace=name_space, id=id)
        if self._state is State.MAPPING:
            created = self._locations.create_here(name_space, id)
        elif self._state is State.PAUSED:
            resume = self._naming("map/resume_from_paused")
            raise StateError(f"{self._naming('graph_loc/create')}: mapping is paused; call {resume} first")
        elif pose is None:
            raise StateError(
                f"{self._naming('graph_loc/create')}: nothing is being mapped and no localiser tells where the robot is"
            )
        else:
            x, y, theta = (float(value) for value in pose)
            created = self._locations.create_at(name_space, id, (x, y, theta))
        self._write(Saved.METADATA)
        return created

    def create_points(self, name_spaces: Sequence[str], points: Sequence[Sequence[float]], ids: Sequence[str]) -> None:
        """Names points (x, y) of the map frame, all relative to the node that is nearest to their centroid."""
        for name_space, id in zip(name_spaces, ids, strict=False):  # their numbers are checked with the points'
            _check_text(namespace=name_space, id=id)
        self._locations.create_points(name_spaces, points, ids)
        self._write(Saved.METADATA)

    def create_area(self, area: Area) -> None:
        """Keeps an area where the robot shall not go, in the place of one of its kind and name."""
        self._locations.clear(area.name_space)
        ids = [str(number) for number in range(len(area.points))]
        self.create_points([area.name_space] * len(ids), area.points, ids)

    def delete_location(self, name_space: str, id: str) -> bool:
        """Forgets a place; whether it was there."""
        deleted = self._locations.delete(name_space, id)
        self._write(Saved.METADATA)
        return deleted

    def clear_locations(self, name_space: str, use_as_prefix: bool = False) -> list[tuple[str, str]]:
        """Forgets all places of a namespace, or of all that begin with it, and returns them."""
        cleared = self._locations.clear(name_space, use_as_prefix)
        self._write(Saved.METADATA)
        return cleared

    def _write(self, what: Saved) -> None:
        """Changes of places reach the disk at once; the rest of the map when mapping stops or save() is called."""
        if self._path and self._mapper.num_nodes > 0:
            self._save(self._path, self._mapper.map(), what)

    def _map_before(self, call: str) -> Map:
        """What the session went on with. Raises StateError if that is nothing, or was accepted."""
        if self._before is None:
            raise StateError(
                f"{self._naming(call)}: no map was gone on with since {self._naming('map/load')}, or it was accepted; "
                f"{self._naming('map/clear')} drops a new map, oort history goes back to an earlier one"
            )
        return self._before

    def _is_own(self, path: str) -> bool:
        """Whether that is where the map is saved already."""
        return bool(self._path) and normalise_map_path(path) == normalise_map_path(self._path)

    def _new_mapper(self) -> Mapper:
        mapper = Mapper(self._parameters, self._sensor_on_base)
        mapper.keep_closure_attempts(self._keep_attempts)
        return mapper

    def _use(self, mapper: Mapper) -> None:
        self._mapper = mapper
        self._before = None
        self._observer = Observer(self._sensor_on_base)
        self._locations = Locations(mapper, self._naming)


def _check_text(**values: object) -> None:
    for name, value in values.items():
        if not isinstance(value, str):
            raise TypeError(f"{name} must be a string, got {value!r}")
        if "\0" in value:
            raise StateError(f"{name} holds a NUL character: {quoted(value)}; no path and no name can")
        if name != "path" and not value.isprintable():
            try:
                value.encode()
            except UnicodeEncodeError:
                raise StateError(f"{name} is no text: {quoted(value)}") from None
