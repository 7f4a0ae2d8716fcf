# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What every reader of recordings delivers."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from oort.errors import InputError

Pose = tuple[float, float, float]
"""x [m], y [m], theta [rad]."""

Sweep = tuple[Pose, Pose]
"""Where the base was at a scan's first and at its last beam, seen from where it was at the stamp."""


@dataclass(frozen=True, slots=True, eq=False, init=False)
class LaserScan:
    """One planar laser scan as a sensor delivers it."""

    ranges: NDArray[np.float32]
    """(n,) [m]; may hold nan and inf, which are no return"""
    angle_min: float
    """bearing of ranges[0] [rad]"""
    angle_increment: float
    """[rad], negative for a clockwise sensor"""
    range_min: float
    """[m]; readings below it are no return"""
    range_max: float
    """[m]; readings at or beyond it are no return"""
    time: float = 0.0
    """[s]; a label, never a sort key"""
    sweep: Sweep | None = None
    """None: all beams were measured at once"""

    def __init__(
        self,
        ranges: ArrayLike,
        angle_min: float,
        angle_increment: float,
        range_min: float,
        range_max: float,
        time: float = 0.0,
        sweep: Sweep | None = None,
    ) -> None:
        """Takes a copy of the ranges, for drivers write to the same memory again.

        Raises InputError if they are not a row of numbers.
        """
        values = {
            "ranges": _row_of(ranges),
            "angle_min": float(angle_min),
            "angle_increment": float(angle_increment),
            "range_min": float(range_min),
            "range_max": float(range_max),
            "time": float(time),
            "sweep": sweep,
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @property
    def readings(self) -> tuple[float, float, float, float, float, NDArray[np.float32]]:
        """The scan as the engine takes it: time, angle_min, angle_increment, range_min, range_max, ranges."""
        return self.time, self.angle_min, self.angle_increment, self.range_min, self.range_max, self.ranges


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scan(LaserScan):
    """A laser scan with the odometry at its stamp."""

    stamp: str
    """the time as the recording writes it, in full precision: the key of this scan in trajectories and relations"""
    odometry: Pose
    """T_odom_base at the stamp"""
    reported_frame: Pose | None = None
    """where the frame is that odometry is reported in, seen from the one of ``odometry``; None: they are the same"""
    mount: Pose | None = None
    """T_base_sensor of another laser than the recording's main one, whose next scan this one joins; None: the main"""
    guessed: bool = False
    """whether the odometry rests on what was known at some moment, so that a later look might tell something else"""


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """A recording that was looked through and can be played, any number of times."""

    name: str
    """the input's base name without its suffixes"""
    kind: str
    """what kind of file it is, for people: "CARMEN log", "ROS 1 bag", "ROS 2 bag" """
    sensor_on_base: Pose
    """T_base_sensor, of the main laser where there are several"""
    num_scans: int
    """how many scans `scans()` delivers"""
    notes: tuple[str, ...]
    """sentences about what was found, taken for granted or skipped"""
    source: Callable[[], Iterator[Scan]]
    without_odometry: str = ""
    """why the scans have no odometry (theirs is the identity then); empty: they have"""

    def require_odometry(self, what: str) -> None:
        """Raises InputError if there is none; ``what`` needs it."""
        if self.without_odometry:
            raise InputError(f"{self.name}: {what} needs odometry, which is missing: {self.without_odometry}")

    def scans(self) -> Iterator[Scan]:
        """The scans in the order of the recording. Raises InputError if the recording cannot be read any more."""
        return self.source()


_MOST_BEAMS = 100_000  # the finest lasers have some 15,000


def _row_of(ranges: ArrayLike) -> NDArray[np.float32]:
    try:
        row = np.array(ranges, dtype=np.float32)
    except (TypeError, ValueError) as error:
        raise InputError(f"LaserScan: the ranges must be numbers [m]: {error}") from None
    if row.size > _MOST_BEAMS:
        raise InputError(
            f"LaserScan: {row.size} beams are more than any laser has, and more than can be matched in time"
        )
    if row.ndim != 1:
        raise InputError(f"LaserScan: the ranges must be one row of numbers, not of shape {row.shape}")
    return row
