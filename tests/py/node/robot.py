# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A robot for the node under test: its laser, its base's odometry and, if asked for, its localiser, all over ROS.

It lives in the test's process and by the wall's clock, faster than a robot: Oort asks for the order of scans only.
"""

import threading
import time
from typing import Self

import numpy as np
import rospy
from numpy.typing import NDArray
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from helpers.course import BASE, COURSE, LASER, MAP, ODOM, SHORT, Course, around_the_room, of_drive
from oort.node.messages import transform

__all__ = [
    "BASE",
    "COURSE",
    "EXTRAPOLATED",
    "LASER",
    "MAP",
    "ODOM",
    "SHORT",
    "Course",
    "Localiser",
    "Robot",
    "around_the_room",
    "of_drive",
]

_BASE_PERIOD = 0.02  # [s] between odometry of a robot that stands
_LASER_PERIOD = 0.1  # [s] between scans of a robot that stands, if its laser is on
_LOCALISER_PERIOD = 0.05  # [s]


EXTRAPOLATED = 0.1  # [s] beyond the last odometry; a later scan waits for more


class Robot:
    """Publishes scans, odom -> base and, once, base -> laser.

    Where it stands, at first at the beginning of `course`, its odometry goes on fifty times a second as long as
    `base_on`, and ten times a second it scans as long as `laser_on`.
    """

    def __init__(self, course: Course, scan_topic: str = "scan", laser: str = LASER) -> None:
        """Needs rospy to be up; `laser` is the frame of its scans. Use as a context, which ends its thread."""
        self.base_on, self.laser_on = True, False
        self._at = course[:1]
        self._laser = laser
        self._scans = rospy.Publisher(scan_topic, LaserScan, queue_size=10_000)
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=10_000, tcp_nodelay=True)
        self._tf_static = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        self._tf_static.publish([transform(BASE, laser, rospy.Time.now(), tuple(course.T_base_laser))])
        self._turn = threading.Lock()  # to publish: driving or standing
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._stand, daemon=True)

    def __enter__(self) -> Self:
        """Begins to stand."""
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Falls silent."""
        self._ended.set()
        self._thread.join()
        for publisher in (self._scans, self._tf, self._tf_static):
            publisher.unregister()

    def wait_for_node(self, name: str = "/oort_slam", timeout: float = 30.0) -> None:
        """Waits until a node receives what the robot publishes."""
        deadline = time.monotonic() + timeout
        for publisher in (self._scans, self._tf, self._tf_static):
            while not any(name == connection.endpoint_id for connection in publisher.impl.connections):
                assert time.monotonic() < deadline, f"{name} does not listen to {publisher.resolved_name}"
                time.sleep(0.01)

    def drive(self, course: Course, rate: float = 200.0, odometry: bool = True) -> list[rospy.Time]:
        """Goes along, with `rate` scans a second [1/s], each followed by odometry; returns the scans' stamps."""
        stamps = []
        with self._turn:
            for here in (course[k : k + 1] for k in range(len(course))):
                started = time.monotonic()
                self._at = here
                stamps.append(self._scan())
                if odometry:
                    self.tell_odometry(stamps[-1:], here)
                time.sleep(max(0.0, started + 1.0 / rate - time.monotonic()))
        return stamps

    def tell_odometry(self, stamps: list[rospy.Time], course: Course) -> None:
        """Publishes odometry for these times."""
        for stamp, pose in zip(stamps, course.T_odom_base.tolist(), strict=True):
            self._tf.publish([transform(ODOM, BASE, stamp, pose)])

    def _scan(self) -> rospy.Time:
        at, stamp = self._at, rospy.Time.now()
        message = LaserScan(
            header=Header(stamp=stamp, frame_id=self._laser),
            angle_min=at.angle_min,
            angle_max=at.angle_min + (at.ranges.shape[1] - 1) * at.angle_increment,
            angle_increment=at.angle_increment,
            range_min=at.range_min,
            range_max=at.range_max,
            ranges=at.ranges[0],
        )
        self._scans.publish(message)
        return stamp

    def _stand(self) -> None:
        next_scan = 0.0
        while not self._ended.wait(_BASE_PERIOD):
            with self._turn:
                if self.laser_on and time.monotonic() >= next_scan:
                    next_scan = time.monotonic() + _LASER_PERIOD
                    self._scan()
                if self.base_on:
                    self.tell_odometry([rospy.Time.now()], self._at)


class Localiser:
    """Publishes map -> odom twenty times a second, as amcl does; the robot must tell its odometry. Use as a context."""

    def __init__(self, T_map_odom: NDArray[np.float64]) -> None:  # noqa: N803
        """Knows (3,) where the odometry frame is."""
        self._pose = tuple(T_map_odom.tolist())
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._tell, daemon=True)

    def __enter__(self) -> Self:
        """Begins to publish."""
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Falls silent."""
        self._ended.set()
        self._thread.join()
        self._tf.unregister()

    def _tell(self) -> None:
        while not self._ended.wait(_LOCALISER_PERIOD):
            self._tf.publish([transform(MAP, ODOM, rospy.Time.now(), self._pose)])
