# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Where the base was while a scan was taken: bags and the ROS node share it, so that both give the same bits."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from oort.poses import Array, between, compose
from oort.recording.types import Pose, Sweep

SNAPSHOT = (0.0, 0.0)
"""The span of a scan whose beams are taken as measured at once."""

_LONGEST = 1.0  # [s]; no planar laser is slower


def beam_span(beams: int, time_increment: float) -> tuple[float, float] | None:
    """When the first and the last beam were measured [s], from the scan's stamp; None if the increment cannot be.

    A negative increment is that of a scan whose beams are told in the reverse order.
    """
    duration = (beams - 1) * float(time_increment)
    return (0.0, duration) if math.isfinite(duration) and abs(duration) <= _LONGEST else None


@dataclass(frozen=True, slots=True)
class Placement:
    """The odometry of one scan; see Scan for the meaning."""

    odometry: Pose
    sweep: Sweep | None = None
    reported_frame: Pose | None = None
    guessed: bool = False

    def of_child(self, fixed: Pose) -> "Placement":
        """The same for a frame that sits at ``fixed`` on the one whose odometry this is."""
        sweep = None
        if self.sweep is not None:
            first, last = (_pose(compose(between(fixed, end), fixed)) for end in self.sweep)
            sweep = first, last
        return replace(self, odometry=_pose(compose(self.odometry, fixed)), sweep=sweep)


def place(lookup: Callable[[float], Pose | None], stamp: float, span: tuple[float, float]) -> Placement | None:
    """The odometry at a stamp [s] and over a span from there; None unless all of it is known."""
    odometry = lookup(stamp)
    if odometry is None or span == SNAPSHOT:
        return None if odometry is None else Placement(odometry)
    first, last = (odometry if offset == 0.0 else lookup(stamp + offset) for offset in span)
    if first is None or last is None:
        return None
    return Placement(odometry, (_pose(between(odometry, first)), _pose(between(odometry, last))))


def _pose(values: Array) -> Pose:
    x, y, theta = values.tolist()
    return x, y, theta
