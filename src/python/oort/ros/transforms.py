# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What tf tells the node: odometry at a scan's stamp, the sensor's place on the base, and a localiser's pose."""

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped

from oort._core import OdometryBuffer, Parameters
from oort.errors import InputError
from oort.live import UnusableScanError
from oort.poses import compose
from oort.recording import Pose
from oort.recording.frames import FrameTree, heading, to_plane, unit_quaternion
from oort.recording.laser_scan import seconds
from oort.ros.messages import yaw

_KEPT = 20.0  # [s] of odometry; scans that come later than that are lost
_BACKWARDS = 1.0  # [s]; a transform that is older than the last one by more says that the clock was set back
_FRESH = 1.0  # [s]; an older pose of a localiser is not where the robot is


def frame(parameters: Parameters, name: str) -> str:
    """The frame of the base, odom, sensor or map, without the slash that old tf wrote."""
    return str(parameters.get(f"{name}_frame")).lstrip("/")


@dataclass(slots=True)
class _Odometry:
    """The transforms from the odometry frame to one child."""

    buffer: OdometryBuffer
    oldest: float
    newest: float
    arrived: float
    """[s] time.monotonic() of the newest"""
    set_back_at: float = -math.inf
    """[s] time.monotonic()"""


@dataclass(frozen=True, slots=True)
class Mount:
    """How the sensor sits on the base."""

    sensor_on_base: Pose
    upside_down: bool


class Transforms(tf2_ros.Buffer):  # type: ignore[misc]
    """tf2's buffer, which also keeps odometry the way a recording's reader does, so that both see the same poses."""

    def __init__(self, parameters: Parameters, on_odometry: Callable[[], None]) -> None:
        """Frames are those of the parameters; ``on_odometry`` is called when odometry came."""
        super().__init__(debug=False)
        self._base, self._odom, self._map = (frame(parameters, name) for name in ("base", "odom", "map"))
        self._on_odometry = on_odometry
        self._lock = threading.Lock()  # /tf and /tf_static have threads of their own
        self._tree = FrameTree()  # the first transform of each link
        self._odometry: dict[str, _Odometry] = {}
        self._mounts: dict[str, Mount] = {}

    def set_transform(self, transform: TransformStamped, authority: str) -> None:
        """Takes a transform from tf."""
        if authority == rospy.get_name():
            return  # what Oort said itself is no localiser's word
        super().set_transform(transform, authority)
        if self._note(transform, moving=True):
            self._on_odometry()

    def set_transform_static(self, transform: TransformStamped, authority: str) -> None:
        """Takes a transform that holds for ever."""
        super().set_transform_static(transform, authority)
        self._note(transform, moving=False)

    # ---- scans ----

    def mount(self, sensor_frame: str) -> Mount | None:
        """T_base_sensor, or None if tf does not tell yet. Raises UnusableScanError if the sensor is not level."""
        known = self._mounts.get(sensor_frame)
        if known is not None:
            return known
        with self._lock:
            try:
                matrix = self._tree.mount(self._base, sensor_frame)
            except InputError:
                return None
        try:
            mount = Mount(*to_plane(matrix, sensor_frame))
        except InputError as error:
            raise UnusableScanError(str(error)) from error
        self._mounts[sensor_frame] = mount
        return mount

    def odometry(self, stamp: float, arrived: float) -> Pose | None:
        """T_odom_base at a scan's stamp [s], or None as long as it may still come.

        ``arrived`` is the scan's time.monotonic(). Raises UnusableScanError if it will not come any more.
        """
        with self._lock:
            way = self._tree.way_up(self._base, self._odom)
            odometry = self._odometry.get(way[-2]) if len(way) > 1 else None
            if odometry is None:
                return None
            pose = odometry.buffer.lookup(stamp)
            if pose is None:
                if stamp < odometry.oldest and arrived < odometry.arrived:  # else the clock may have been set back
                    raise UnusableScanError("older than the odometry")
                if arrived < odometry.set_back_at and stamp > odometry.newest + _BACKWARDS:
                    raise UnusableScanError("from before the clock was set back")
                return None
            if len(way) == 2:
                return pose
            x, y, theta = compose(pose, to_plane(self._tree.mount(way[-2], self._base), self._base)[0]).tolist()
            return x, y, theta

    def missing(self, sensor_frame: str) -> str:
        """Says what scans wait for, such as "no odom -> base_footprint since 2.3 s"."""
        with self._lock:
            if not self._tree.way_up(sensor_frame, self._base) and sensor_frame != self._base:
                return f"no {self._base} -> {sensor_frame} (tf has {self._tree.describe()})"
            way = self._tree.way_up(self._base, self._odom)
            if len(way) < 2:
                return f"no {self._odom} -> {self._base} (tf has {self._tree.describe()})"
            silence = time.monotonic() - self._odometry[way[-2]].arrived
        return f"no {self._odom} -> {self._base} since {silence:.1f} s"

    # ---- a localiser ----

    def sensor_on_map(self, sensor_frame: str) -> Pose | None:
        """T_map_sensor as other programs tell it, if that is of now."""
        try:
            transform = self.lookup_transform(self._map, sensor_frame, rospy.Time(0))
        except tf2_ros.TransformException:
            return None
        stamp = transform.header.stamp
        if stamp and abs((rospy.Time.now() - stamp).to_sec()) > _FRESH:
            return None  # a stamp of 0 is of static transforms only
        translation, rotation = transform.transform.translation, transform.transform.rotation
        return translation.x, translation.y, yaw(rotation)

    # ---- what comes in ----

    def _note(self, transform: TransformStamped, moving: bool) -> bool:
        """Keeps what the scans need; whether it was odometry."""
        parent, child = transform.header.frame_id.lstrip("/"), transform.child_frame_id.lstrip("/")
        t, r = transform.transform.translation, transform.transform.rotation
        rotation = unit_quaternion(r.x, r.y, r.z, r.w)
        if rotation is None or not all(map(math.isfinite, (t.x, t.y, t.z))):
            return False
        stamp = seconds(transform.header.stamp.secs, transform.header.stamp.nsecs)
        with self._lock:
            if parent not in self._tree.links.get(child, {}):
                self._tree.add(parent, child, stamp, (t.x, t.y, t.z), (r.x, r.y, r.z, r.w))
            if parent != self._odom or not moving:
                return False
            self._add_odometry(child, stamp, (t.x, t.y, heading(*rotation)))
        return True

    def _add_odometry(self, child: str, stamp: float, pose: Pose) -> None:
        now = time.monotonic()
        odometry = self._odometry.get(child)
        if odometry is None or stamp < odometry.newest - _BACKWARDS:
            set_back_at = -math.inf if odometry is None else now
            if odometry is not None:
                self.clear()  # tf2 would refuse what is older
            odometry = self._odometry[child] = _Odometry(OdometryBuffer(_KEPT), stamp, stamp, now, set_back_at)
        odometry.buffer.add(stamp, *pose)
        odometry.newest = max(odometry.newest, stamp)
        odometry.oldest = max(odometry.oldest, odometry.newest - _KEPT)
        odometry.arrived = now
