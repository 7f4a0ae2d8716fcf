# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""From the fields of a LaserScan message to a Scan: bags and the ROS node share it, so that both give the same bits."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from oort.recording.limits import NO_LIMITS, ScanLimits
from oort.recording.motion import Placement
from oort.recording.types import Pose, Scan


def seconds(whole: int, nanoseconds: int) -> float:
    """A stamp of ROS as one number [s]."""
    return float(whole) + float(nanoseconds) / 1e9


def scan_from_message(
    *,
    whole_seconds: int,
    nanoseconds: int,
    angle_min: float,
    angle_increment: float,
    range_min: float,
    range_max: float,
    ranges: Sequence[float] | NDArray[np.float32],
    placement: Placement,
    upside_down: bool,
    limits: ScanLimits = NO_LIMITS,
    mount: Pose | None = None,
) -> Scan:
    """A Scan of what a LaserScan says in its own frame; `placement` is its odometry, `mount` as of Scan.

    `upside_down` is for a laser whose z axis points down: its beams are put in the order in which they turn
    counter-clockwise on the base.
    """
    sweep = placement.sweep
    values = np.array(ranges, dtype=np.float32)
    angle_min, angle_increment = float(angle_min), float(angle_increment)
    values = limits.usable(values, angle_min, angle_increment)
    if upside_down:  # mirrored, beam i points where bearing -(angle_min + i * increment) is
        angle_min = -(angle_min + (len(values) - 1) * angle_increment)
        values = values[::-1].copy()
        sweep = None if sweep is None else (sweep[1], sweep[0])
    return Scan(
        time=seconds(whole_seconds, nanoseconds),
        stamp=f"{whole_seconds}.{nanoseconds:09d}",
        angle_min=angle_min,
        angle_increment=angle_increment,
        range_min=limits.range_min(range_min),
        range_max=limits.range_max(range_max),
        ranges=values,
        odometry=placement.odometry,
        sweep=sweep,
        mount=mount,
        reported_frame=placement.reported_frame,
        guessed=placement.guessed,
    )
