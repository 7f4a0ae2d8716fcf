# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What a robot measures on its way, for the tests of nodes in either ROS."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from helpers.scenes import room_scan
from oort.poses import between, compose
from oort.simulate import Drive

MAP, ODOM, BASE, LASER = "map", "odom", "base_footprint", "hokuyo_laser_link"
_LASER_ON_BASE = (0.109, 0.0, 0.0)
_ODOM_TO_ROOM = (3.0, 4.0, 0.5)  # T_odom_room: odometry begins anywhere


@dataclass(frozen=True, eq=False)
class Course:
    """What a robot measures on its way: n scans, and where odometry sees its base at each."""

    ranges: NDArray[np.float32]
    """(n, beams) [m]"""
    T_odom_base: NDArray[np.float64]
    """(n, 3)"""
    angle_min: float
    angle_increment: float
    range_min: float
    range_max: float
    T_base_laser: NDArray[np.float64]
    """(3,)"""

    def __len__(self) -> int:
        """How many scans."""
        return len(self.ranges)

    def __getitem__(self, part: slice) -> Self:
        """A part of the way."""
        return replace(self, ranges=self.ranges[part], T_odom_base=self.T_odom_base[part])

    @property
    def T_odom_laser(self) -> NDArray[np.float64]:  # noqa: N802
        """(n, 3)"""
        return compose(self.T_odom_base, self.T_base_laser)

    @property
    def T_map_odom(self) -> NDArray[np.float64]:  # noqa: N802
        """(3,) of the map that Oort makes of this way, as far as odometry is right: its origin is the first scan's."""
        return between(self.T_odom_laser[0], np.zeros(3))


def around_the_room(laps: float = 1.0) -> Course:
    """Circles of 0.4 m radius in the room of `scenes`, with perfect odometry: 120 scans each, and one more."""
    turned = np.arange(round(120 * laps) + 1) * (2.0 * np.pi / 120)
    on_room = np.column_stack([0.4 * np.sin(turned), 0.4 * (1.0 - np.cos(turned)), turned])
    scans = [room_scan(x, y, theta, 0.0) for x, y, theta in compose(on_room, _LASER_ON_BASE).tolist()]
    one = scans[0]
    return Course(
        ranges=np.stack([scan.ranges for scan in scans]),
        T_odom_base=compose(_ODOM_TO_ROOM, on_room),
        angle_min=one.angle_min,
        angle_increment=one.angle_increment,
        range_min=one.range_min,
        range_max=one.range_max,
        T_base_laser=np.array(_LASER_ON_BASE),
    )


def of_drive(drive: Drive) -> Course:
    """All of a simulated drive; slice it for less."""
    return Course(
        ranges=drive.ranges,
        T_odom_base=drive.T_odom_base_at_scans,
        angle_min=drive.angle_min,
        angle_increment=drive.angle_increment,
        range_min=drive.range_min,
        range_max=drive.range_max,
        T_base_laser=drive.T_base_sensor,
    )


COURSE = around_the_room()
SHORT = COURSE[:40]
