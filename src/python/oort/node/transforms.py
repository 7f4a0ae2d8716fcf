# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What tf tells the node: odometry at a scan's stamp, the sensor's place on the base, and a localiser's pose."""

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import Imu

from oort._core import Parameters
from oort.errors import InputError
from oort.live import UnusableScanError
from oort.live.odometry import Odometry
from oort.node.logs import log, once
from oort.node.messages import stamp_parts
from oort.node.middleware import Middleware
from oort.node.recent import RecentTransforms
from oort.recording import Pose
from oort.recording.frames import FrameTree, describe_variation, heading, to_plane, unit_quaternion
from oort.recording.gyro import LEVEL, Vector, angular_velocity, upward, yaw_rate
from oort.recording.laser_scan import seconds
from oort.recording.motion import Placement

_FRESH = 1_000_000_000  # [ns]; an older pose of a localiser is not where the robot is
_IMU_PATIENCE = 5.0  # [s] of the wall's clock that an IMU's transform may come later than its first message
_SILENCE = 2.0  # [s] of the wall's clock without a word from the localiser, for ROS time may stand still


def frame(parameters: Parameters, name: str) -> str:
    """The frame of the base, odom, sensor or map, without the slash that old tf wrote."""
    return str(parameters.get(f"{name}_frame")).lstrip("/")


@dataclass(frozen=True, slots=True)
class Mount:
    """How the sensor sits on the base."""

    sensor_on_base: Pose
    upside_down: bool


class Transforms:
    """Keeps odometry the way a recording's reader does, so that both see the same poses, and what else is looked up."""

    def __init__(self, parameters: Parameters, on_odometry: Callable[[], None], middleware: Middleware) -> None:
        """Frames are those of the parameters; ``on_odometry`` is called when odometry came."""
        self._middleware = middleware
        self._say_level = once()
        self._recent = RecentTransforms()
        self._base, self._odom, self._map = (frame(parameters, name) for name in ("base", "odom", "map"))
        self._on_odometry = on_odometry
        self._max_extrapolation = float(parameters.get("max_extrapolation"))
        self._use_odometry = bool(parameters.get("use_odometry"))
        self._use_imu = bool(parameters.get("use_imu"))
        self._imu_axes: dict[str, Vector] = {}  # upward in the IMU's frame, as tf tells it
        self._imus: dict[str, float] = {}  # [s] time.monotonic() of the first message of each IMU's frame
        self._imu_heard = -math.inf  # [s] time.monotonic()
        self._lock = threading.Lock()  # /tf and /tf_static have threads of their own
        self._tree = FrameTree()  # the first transform of each link
        self._odometry: dict[str, Odometry] = {}  # by the child of the odometry frame
        self._mounts: dict[str, Mount] = {}
        self._fixed: set[tuple[str, str]] = set()  # (child, parent) of the links that sensors rest on
        self._localised: dict[str, float] = {}  # [s] time.monotonic() of the last word, by the child of the map frame

    def set_transform(self, transform: TransformStamped, authority: str) -> None:
        """Takes a transform from tf; ``authority`` is the node that sent it."""
        if authority == self._middleware.name:
            return  # what Oort said itself is no localiser's word
        if self._note(transform, moving=True):
            self._on_odometry()

    def set_transform_static(self, transform: TransformStamped, authority: str) -> None:
        """Takes a transform that holds for ever."""
        self._note(transform, moving=False)

    # ---- scans ----

    def mount(self, sensor_frame: str) -> Mount | None:
        """T_base_sensor, or None if tf does not tell yet. Raises UnusableScanError if the sensor is not level."""
        known = self._mounts.get(sensor_frame)
        if known is not None:
            return known
        with self._lock:
            try:
                ways = self._tree.ways(self._base, sensor_frame)
            except InputError:
                return None
            self._fixed.update(link for way in ways for link in pairwise(way))
            matrix = self._tree.mount(self._base, sensor_frame)
        try:
            mount = Mount(*to_plane(matrix, sensor_frame))
        except InputError as error:
            raise UnusableScanError(str(error)) from error
        self._mounts[sensor_frame] = mount
        return mount

    def place(
        self, stamp: float, arrived: float, span: tuple[float, float], last_resort: bool = False
    ) -> Placement | None:
        """The odometry of a scan, or None as long as it may still come; see Odometry.place.

        ``arrived`` is the scan's time.monotonic(). Raises UnusableScanError if it will not come any more.
        """
        if not self._use_odometry:
            return Placement((0.0, 0.0, 0.0))
        with self._lock:
            way = self._tree.way_up(self._base, self._odom)
            odometry = self._odometry.get(way[-2]) if len(way) > 1 else None
            placement = None if odometry is None else odometry.place(stamp, arrived, span, last_resort)
            if placement is None or len(way) == 2:
                return placement
            return placement.of_child(to_plane(self._tree.mount(way[-2], self._base), self._base)[0])

    def missing(self, sensor_frame: str) -> str:
        """Says what scans wait for, such as "no odom -> base_footprint since 2.3 s"."""
        name = f"{self._odom} -> {self._base}"
        with self._lock:
            if not self._tree.way_up(sensor_frame, self._base) and sensor_frame != self._base:
                return f"no {self._base} -> {sensor_frame} (tf has {self._tree.describe()})"
            if not self._use_odometry:
                return "no odometry is used"
            way = self._tree.way_up(self._base, self._odom)
            if len(way) < 2:
                return f"no {name} (tf has {self._tree.describe()})"
            odometry = self._odometry.get(way[-2])
            return f"{name} is static: no odometry" if odometry is None else odometry.lack(name)

    # ---- an IMU ----

    def add_imu(self, message: Imu) -> None:
        """Takes the yaw rate of an IMU's message; what tells none is left out."""
        rate = angular_velocity(message)
        stamp = seconds(*stamp_parts(message.header.stamp))
        with self._lock:
            axis = None if rate is None else self._imu_axis(message.header.frame_id.lstrip("/"))
            if rate is None or axis is None:
                return
            self._imu_heard = time.monotonic()
            for odometry in self._odometry.values():
                odometry.add_gyro(stamp, yaw_rate(rate, axis))
        self._on_odometry()

    def imu_trouble(self) -> str:
        """Why an IMU that is to be used turns nothing of odometry, and what to do; empty if it does."""
        if not (self._use_imu and self._use_odometry):
            return ""
        with self._lock:
            if self._odometry and time.monotonic() > self._imu_heard + _SILENCE:
                topic = self._middleware.resolve("imu")
                return f"no yaw rate on {topic}; start the IMU, remap imu, or set use_imu to false"
            way = self._tree.way_up(self._base, self._odom)
            odometry = self._odometry.get(way[-2]) if len(way) > 1 else None
            return "" if odometry is None else odometry.gyro_trouble()

    def _imu_axis(self, imu_frame: str) -> Vector | None:
        """Upward in the IMU's frame; None as long as tf may still tell."""
        if imu_frame not in self._imu_axes:
            heard = self._imus.setdefault(imu_frame, time.monotonic())
            axis = upward(self._tree, self._base, imu_frame)
            if axis is None:
                if not self._mounts or time.monotonic() < heard + _IMU_PATIENCE:
                    return None
                self._say_level(f"no {self._base} -> {imu_frame}: the IMU is taken to sit level")
                return LEVEL  # until tf tells
            self._imu_axes[imu_frame] = axis
            if imu_frame != self._base:
                ways = self._tree.ways(self._base, imu_frame)
                self._fixed.update(link for way in ways for link in pairwise(way))
        return self._imu_axes[imu_frame]

    # ---- a localiser ----

    def sensor_on_map(self, sensor_frame: str) -> Pose | None:
        """T_map_sensor as other programs tell it, if that is of now."""
        with self._lock:
            way = self._tree.way_up(sensor_frame, self._map)
            if len(way) > 1 and time.monotonic() > self._localised[way[-2]] + _SILENCE:
                return None
            latest = self._recent.latest(self._map, sensor_frame)
        if latest is None:
            return None
        stamp, matrix = latest
        if stamp and abs(self._middleware.now() - stamp) > _FRESH:
            return None  # a stamp of 0 is of static transforms only
        return float(matrix[0, 3]), float(matrix[1, 3]), math.atan2(matrix[1, 0], matrix[0, 0])

    def is_localised(self) -> bool:
        """Whether another program says now where odometry's frame is on the map."""
        with self._lock:
            told = self._localised.get(self._odom)
            return told is not None and time.monotonic() <= told + _SILENCE

    # ---- what comes in ----

    def _note(self, transform: TransformStamped, moving: bool) -> bool:
        """Keeps what the scans need; whether it was odometry."""
        parent, child = transform.header.frame_id.lstrip("/"), transform.child_frame_id.lstrip("/")
        t, r = transform.transform.translation, transform.transform.rotation
        rotation = unit_quaternion(r.x, r.y, r.z, r.w)
        if rotation is None or not all(map(math.isfinite, (t.x, t.y, t.z))):
            return False
        whole, nanoseconds = stamp_parts(transform.header.stamp)
        stamp = seconds(whole, nanoseconds)
        sample = whole * 1_000_000_000 + nanoseconds, (t.x, t.y, t.z), rotation
        pose = t.x, t.y, heading(*rotation)
        with self._lock:
            self._recent.add(parent, child, sample, fixed=not moving)
            if parent not in self._tree.links.get(child, {}):
                self._tree.add(parent, child, stamp, (t.x, t.y, t.z), (r.x, r.y, r.z, r.w))
            if (child, parent) in self._fixed:
                self._compare(parent, child, pose)
            if parent == self._map:
                self._localised[child] = time.monotonic() if moving else math.inf
            if parent != self._odom or not moving:
                return False
            self._odometry_of(child).add(stamp, pose)
        return True

    def _odometry_of(self, child: str) -> Odometry:
        if child not in self._odometry:
            self._odometry[child] = Odometry(max_extrapolation=self._max_extrapolation, use_gyro=self._use_imu)
        return self._odometry[child]

    def _compare(self, parent: str, child: str, pose: Pose) -> None:
        """Complains, once, of a link that carries a sensor and moves."""
        first = self._tree.links[child][parent].by_time()[0, 1:]
        variation = describe_variation(parent, child, first, pose, "sensor")
        if variation:
            log.warning("%s; mapping goes on as if it had not moved", variation)
            self._fixed.remove((child, parent))
