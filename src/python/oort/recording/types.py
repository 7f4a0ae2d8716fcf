# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What every reader of recordings delivers."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Pose = tuple[float, float, float]
"""x [m], y [m], theta [rad]."""

Sweep = tuple[Pose, Pose]
"""Where the base was at a scan's first and at its last beam, seen from where it was at the stamp."""


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """One laser scan with the odometry at its stamp."""

    time: float
    """[s]; a label, never a sort key"""
    stamp: str
    """the time as the recording writes it, in full precision: the key of this scan in trajectories and relations"""
    angle_min: float
    """bearing of ranges[0] [rad]"""
    angle_increment: float
    """[rad]"""
    range_min: float
    """[m]; readings below it are no return"""
    range_max: float
    """[m]; readings at or beyond it are no return"""
    ranges: NDArray[np.float32]
    """(n,) [m]; may hold nan and inf, which are no return"""
    odometry: Pose
    """T_odom_base at the stamp"""
    sweep: Sweep | None = None
    """None: all beams were measured at once"""
    reported_frame: Pose | None = None
    """where the frame is that odometry is reported in, seen from the one of ``odometry``; None: they are the same"""
    guessed: bool = False
    """whether the odometry rests on what was known at some moment, so that a later look might tell something else"""

    @property
    def arguments(self) -> tuple[float, float, float, float, float, NDArray[np.float32], Pose, Sweep | None]:
        """What Mapper.add_scan and Localizer.add_scan take."""
        limits = self.angle_min, self.angle_increment, self.range_min, self.range_max
        return (self.time, *limits, self.ranges, self.odometry, self.sweep)


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """A recording that was looked through and can be played, any number of times."""

    name: str
    """the input's base name without its suffixes"""
    kind: str
    """what kind of file it is, for people: "CARMEN log", "ROS 1 bag", "ROS 2 bag" """
    sensor_on_base: Pose
    """T_base_sensor"""
    num_scans: int
    """how many scans `scans()` delivers"""
    notes: tuple[str, ...]
    """sentences about what was found, taken for granted or skipped"""
    source: Callable[[], Iterator[Scan]]

    def scans(self) -> Iterator[Scan]:
        """The scans in the order of the recording. Raises InputError if the recording cannot be read any more."""
        return self.source()
