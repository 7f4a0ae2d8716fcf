# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A saved map of the room that the course leads around."""

from pathlib import Path

from helpers.course import COURSE
from oort import Parameters, save_map
from oort.recording import Scan
from oort.session import Session


def save_room(path: Path) -> str:
    """With a dock where the course begins; the map's base path."""
    session = Session(Parameters(), tuple(COURSE.T_base_laser.tolist()))
    session.start()
    session.create_location("dock", "dock")
    for k in range(len(COURSE)):
        x, y, theta = COURSE.T_odom_base[k].tolist()
        scan = Scan(
            COURSE.ranges[k],
            COURSE.angle_min,
            COURSE.angle_increment,
            COURSE.range_min,
            COURSE.range_max,
            100.0 + 0.1 * k,
            stamp=f"{100.0 + 0.1 * k:.6f}",
            odometry=(x, y, theta),
        )
        session.add_scan(scan)
    session.stop()
    save_map(str(path), session.map)
    return str(path)
