# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A robot for nodes in either ROS: it drives a course, faster than a robot would, and stands."""

import time
from typing import Any

from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from helpers.course import BASE, LASER, ODOM, Course
from node.peer import Peer
from oort.node.messages import transform


class Rover:
    """Its laser, its odometry, and where the laser sits."""

    def __init__(self, peer: Peer, course: Course, *, scan: str = "/scan", tf: str = "/tf", base: str = BASE) -> None:
        """Waits until a node listens."""
        self._peer = peer
        self._base = base
        fixed = peer.publisher(f"{tf}_static", TFMessage, latched=True)
        x, y, theta = course.T_base_laser.tolist()
        fixed(TFMessage(transforms=[transform(base, LASER, peer.now(), (x, y, theta))]))
        self._tf = peer.publisher(tf, TFMessage)
        self._scan = peer.publisher(scan, LaserScan)
        time.sleep(0.2)  # where discovery goes by halves, the latched transform may still be on its way

    def drive(self, course: Course, rate: float = 100.0, odometry: bool = True) -> list[Any]:
        """Goes along, with so many scans a second [1/s], each followed by odometry; the scans' stamps."""
        stamps = []
        for number in range(len(course)):
            started = time.monotonic()
            stamps.append(self._peer.now())
            self.scan(course, number, stamps[-1])
            if odometry:
                self.tell_odometry(course, number, stamps[-1])
            time.sleep(max(0.0, started + 1.0 / rate - time.monotonic()))
        return stamps

    def tell_odometry(self, course: Course, number: int, stamp: Any) -> None:
        """Of one scan."""
        x, y, theta = course.T_odom_base[number].tolist()
        self._tf(TFMessage(transforms=[transform(ODOM, self._base, stamp, (x, y, theta))]))

    def scan(self, course: Course, number: int, stamp: Any) -> None:
        """One."""
        message = LaserScan(
            angle_min=course.angle_min,
            angle_max=course.angle_min + (course.ranges.shape[1] - 1) * course.angle_increment,
            angle_increment=course.angle_increment,
            range_min=course.range_min,
            range_max=course.range_max,
            ranges=course.ranges[number].tolist(),
        )
        message.header.stamp, message.header.frame_id = stamp, LASER
        self._scan(message)
