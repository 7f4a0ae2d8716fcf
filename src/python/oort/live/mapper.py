# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A robot's live loop without ROS: scans and odometry pushed from any thread, the pose told at any time."""

import logging
import math
import os
import threading
import time as clock
from collections.abc import Callable
from functools import partial
from types import TracebackType

from numpy.typing import ArrayLike

from oort._core import Map, Parameters, normalise_map_path
from oort.areas import Area
from oort.errors import InputError, StateError
from oort.live.figures import Tracking
from oort.live.listener import Listener
from oort.live.odometry import Odometry
from oort.live.session import LiveSession
from oort.poses import as_pose, compose
from oort.recording import LaserScan, Pose, Scan
from oort.recording.motion import SNAPSHOT, Placement, beam_span
from oort.session import Session

_NAMES = {
    "map/start": "LiveMapper",
    "map/load": "LiveMapper",
    "map/resume": "LiveMapper",
    "map/notify_docked": "LiveMapper.notify_docked",
    "map/pause": "LiveMapper.pause",
    "map/resume_from_paused": "LiveMapper.resume_from_paused",
    "map/stop": "LiveMapper.close",
    "graph_loc/create": "LiveMapper.create_location",
    "graph_loc/locate": "LiveMapper.locate",
    "graph_loc/list": "LiveMapper.map().locations",
}


class LiveMapper:
    """Maps a drive while it happens, in threads of its own. Thread-safe; a context manager that closes itself.

    Odometry comes at its own rate: a scan waits until the odometry on both sides of its stamp has come, and is mapped
    with what lies between. Both are stamped by the same clock. A scan that cannot be mapped is left out and told of.
    """

    def __init__(
        self,
        config: Parameters | None = None,
        *,
        sensor_on_base: ArrayLike = (0.0, 0.0, 0.0),
        save_to: str | os.PathLike[str] = "",
        resume: tuple[str | os.PathLike[str], ArrayLike] | None = None,
        on_trouble: Callable[[str], None] | None = None,
    ) -> None:
        """Begins a map, or goes on with a saved one in a new session.

        ``config`` are the parameters, the defaults if not given; ``sensor_on_base`` is T_base_sensor. The map is saved
        at the path ``save_to`` every 15 s and at the end; a map that is there already is kept beside it as .previous.
        ``resume`` is the path of a map to go on with, and about where the sensor is on it. ``on_trouble`` hears what
        goes wrong while no caller waits, from another thread; if not given, the logger "oort" does.

        Raises MapFileError if a path cannot be used, StateError if the pose is far from the map.
        """
        parameters = Parameters() if config is None else config
        self._use_odometry = bool(parameters.get("use_odometry"))
        self._compensates_motion = bool(parameters.get("motion_compensation"))
        self._lock = threading.Lock()  # of the odometry
        self._odometry = Odometry(
            max_extrapolation=float(parameters.get("max_extrapolation")), use_gyro=bool(parameters.get("use_imu"))
        )
        self._newest: Pose | None = None  # T_odom_base
        self._path = os.path.abspath(save_to) if save_to else ""
        self._last_map: Map | None = None  # of a mapper that is closed
        self._closing = threading.Lock()
        mount = as_pose(sensor_on_base, "LiveMapper: sensor_on_base")
        self._live = LiveSession(parameters, _Teller(on_trouble), naming=_named, draws=False)
        self._live.mount_sensor(mount)
        try:
            self._begin(resume)
        except BaseException:
            self._live.close()
            raise

    def _begin(self, resume: tuple[str | os.PathLike[str], ArrayLike] | None) -> None:
        if resume is None:
            self._live.call("map/start", [self._path])
            return
        self._live.call("map/load", [os.path.abspath(resume[0])])
        self._live.call("map/resume", [self._path, as_pose(resume[1], "LiveMapper: the pose to resume at")])

    # ---- what comes in ----

    def push_odometry(self, time: float, pose: ArrayLike) -> None:
        """Takes T_odom_base at a time [s]. Raises InputError if it is not finite."""
        self._check_open("push_odometry")
        base = as_pose(pose, "LiveMapper.push_odometry: the pose")
        if not all(map(math.isfinite, (time, *base))):
            raise InputError(f"LiveMapper.push_odometry: {base} at {time} s is not finite")
        with self._lock:
            self._odometry.add(time, base)
            self._newest = base
        self._live.inbox.poke()

    def push_gyro(self, time: float, yaw_rate: float) -> None:
        """Takes a yaw rate of the base [rad/s] at a time [s]; it counts where the parameter use_imu is on."""
        self._check_open("push_gyro")
        if not (math.isfinite(time) and math.isfinite(yaw_rate)):
            raise InputError(f"LiveMapper.push_gyro: {yaw_rate} rad/s at {time} s is not finite")
        with self._lock:
            self._odometry.add_gyro(time, yaw_rate)
        self._live.inbox.poke()

    def push_scan(self, scan: LaserScan, time_increment: float = 0.0) -> None:
        """Takes a scan; returns at once.

        ``time_increment`` [s] is from beam to beam, for a sensor whose beams come one after the other: odometry tells
        how the base moved meanwhile, unless the scan's own sweep does. Raises InputError if it cannot be.
        """
        self._check_open("push_scan")
        if not isinstance(scan, LaserScan):
            raise InputError(f"LiveMapper.push_scan: takes an oort.LaserScan, not {type(scan).__name__}")
        span = beam_span(len(scan.ranges), time_increment)
        if span is None:
            raise InputError(f"LiveMapper.push_scan: a time_increment of {time_increment} s cannot be")
        if scan.sweep is not None or not self._compensates_motion or not self._use_odometry:
            span = SNAPSHOT
        resolve = partial(self._resolve, scan, span, clock.monotonic())
        self._live.add_scan(resolve, partial(resolve, last_resort=True))

    def _resolve(
        self, scan: LaserScan, span: tuple[float, float], arrived: float, last_resort: bool = False
    ) -> Scan | None:
        placement: Placement | None = Placement((0.0, 0.0, 0.0))
        if self._use_odometry:
            with self._lock:
                placement = self._odometry.place(scan.time, arrived, span, last_resort)
        if placement is None:
            return None
        return Scan(
            scan.ranges,
            scan.angle_min,
            scan.angle_increment,
            scan.range_min,
            scan.range_max,
            scan.time,
            scan.sweep or placement.sweep,
            stamp=f"{scan.time:.9f}",
            odometry=placement.odometry,
            reported_frame=placement.reported_frame,
            guessed=placement.guessed,
        )

    def notify_docked(self) -> bool | None:
        """Says that the robot stands at its dock; whether what it sees fits the dock. Raises StateError before a scan.

        Comes in its turn, after the scans that were pushed before, and is worked on beside those that come after. None
        if they stop coming first: then it is done when they go on, or by close().
        """
        found = self._call("map/notify_docked")
        return None if found is None else bool(found)

    def pause(self) -> None:
        """Takes no scans until resume_from_paused(): the robot is moved."""
        self._call("map/pause")

    def resume_from_paused(self) -> None:
        """Takes scans again; the edge across the pause is very uncertain."""
        self._call("map/resume_from_paused")

    def create_location(self, name_space: str, id: str) -> None:
        """Names where the sensor is now; the namespace "dock" is for docks. Raises StateError if no scan comes."""
        self._check_open("create_location")
        self._live.places.create(name_space, id)

    def create_area(self, area: Area) -> None:
        """Keeps an area where the robot shall not go, in the place of one of its kind and name."""
        self._check_open("create_area")
        ids = [str(number) for number in range(len(area.points))]
        self._live.call("graph_loc/clear", [area.name_space, False])
        self._live.call("graph_loc/create_points", [[area.name_space] * len(ids), area.points, ids])

    # ---- what can be asked for ----

    def pose(self) -> Pose | None:
        """T_map_base at the newest odometry, without odometry at the newest scan that was mapped.

        None before the first node. Never waits for the mapping.
        """
        snapshot = self._live.snapshot
        T_map_odom, newest = snapshot.odom_pose, self._newest if self._use_odometry else snapshot.made_odometry
        if T_map_odom is None or newest is None:
            return None
        x, y, theta = compose(T_map_odom, newest).tolist()
        return x, y, theta

    @property
    def T_map_odom(self) -> Pose | None:  # noqa: N802
        """Where odometry's frame is on the map; None before the first node. Never waits for the mapping."""
        return self._live.snapshot.odom_pose

    @property
    def tracking(self) -> Tracking:
        """How well the robot's place is known."""
        return self._live.figures.tracking(self._live.snapshot.state)

    @property
    def session(self) -> LiveSession:
        """The session behind, for what watches it, such as oort.view.Viewer."""
        return self._live

    def locate(self, name_space: str, id: str) -> Pose:
        """Where a place is now on the map. Raises StateError if it is not known, or not yet."""
        return self._live.places.locate(name_space, id)

    def map(self) -> Map:
        """A snapshot of the map with all scans that were pushed before."""
        return self._last_map if self._last_map is not None else self._live.run(_map_of)

    def save(self, path: str | os.PathLike[str] | None = None) -> None:
        """Saves the map with all scans that were pushed before, at ``save_to`` or at another path.

        Raises StateError if there is no path, MapFileError if the map cannot be written.
        """
        target = os.path.abspath(path) if path else self._path
        if not target:
            raise StateError("LiveMapper.save: give a path here, or save_to when the LiveMapper is made")
        is_own = bool(self._path) and normalise_map_path(target) == normalise_map_path(self._path)
        if is_own and self._last_map is None:
            self._live.run(Session.save)
        else:
            self.map().save(target)

    # ---- the end ----

    def close(self) -> None:
        """Maps what is ready, solves and refines the map, saves it at ``save_to`` and ends the threads.

        map(), save() and locate() still answer. Raises MapFileError if the map cannot be saved there.
        """
        with self._closing:
            if self._last_map is not None:
                return
            try:
                self._live.call("map/stop")
            finally:
                self._last_map = self._live.run(_map_of)
                self._live.close()

    def __enter__(self) -> "LiveMapper":
        """Itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes, whatever happened: what was mapped is kept."""
        self.close()

    def _call(self, call: str) -> object:
        self._check_open(_named(call).rpartition(".")[2])
        return self._live.call(call)

    def _check_open(self, method: str) -> None:
        if self._last_map is not None:
            raise StateError(f"LiveMapper.{method}: this LiveMapper is closed; make another one, maybe with resume")


class _Teller(Listener):
    """Passes on what nobody waits to hear of."""

    def __init__(self, on_trouble: Callable[[str], None] | None) -> None:
        self._logger = logging.getLogger("oort")
        self._on_trouble = on_trouble or self._logger.warning

    def note(self, text: str) -> None:
        """Something that its owner should know."""
        self._logger.info("%s", text)

    def trouble(self, text: str) -> None:
        """Something went wrong that no caller waits to hear of."""
        self._on_trouble(text)


def _named(call: str) -> str:
    return _NAMES.get(call, call)


def _map_of(session: Session) -> Map:
    return session.map
