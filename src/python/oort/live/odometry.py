# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry as it comes in: where the base was at a scan's stamp, or why that is not known (yet)."""

import math
import time

from oort._core import OdometryBuffer
from oort.live.inbox import UnusableScanError
from oort.recording import Pose

_KEPT = 20.0  # [s] of odometry; scans that come later than that are lost
_BACKWARDS = 1.0  # [s]; a pose or scan that is older than the last one by more says that the clock was set back
_AHEAD = 1.0  # [s]; scans are no more than a message's delay ahead of odometry that flows


class Odometry:
    """The poses of one frame in odometry's, since the clock was set back last. Not thread-safe."""

    def __init__(self) -> None:
        """Nothing came so far."""
        self._buffer = OdometryBuffer(_KEPT)
        self._oldest, self._newest = math.inf, -math.inf  # stamps that it covers [s]
        self._last_scan = self._asked_for = -math.inf  # stamps: of the last scan with a pose, and of the last one [s]
        self._arrived = self._set_back_at = self._last_scan_arrived = -math.inf  # by time.monotonic() [s]

    def add(self, stamp: float, pose: Pose) -> bool:
        """Takes a pose; whether it says that the clock was set back, so that all earlier ones are void."""
        self._arrived = time.monotonic()
        set_back = stamp < self._newest - _BACKWARDS
        if set_back:
            self._buffer = OdometryBuffer(_KEPT)
            self._oldest, self._newest = math.inf, -math.inf
            self._set_back_at = self._arrived
        self._buffer.add(stamp, *pose)
        self._newest = max(self._newest, stamp)
        self._oldest = max(min(self._oldest, stamp), self._newest - _KEPT)
        return set_back

    def at(self, stamp: float, arrived: float) -> Pose | None:
        """The pose at a scan's stamp [s], or None as long as it may still come.

        ``arrived`` is the scan's time.monotonic(). Raises UnusableScanError if it will not come any more.
        """
        self._asked_for = stamp
        if stamp < self._last_scan - _BACKWARDS and self._set_back_at < self._last_scan_arrived:
            return None  # the scans' clock was set back: what is known of that time is of its first passing
        pose: Pose | None = self._buffer.lookup(stamp)
        if pose is not None:
            self._last_scan, self._last_scan_arrived = stamp, arrived
        elif stamp < self._oldest and arrived < self._arrived:  # else the clock may have been set back
            raise UnusableScanError("older than the odometry")
        elif arrived < self._set_back_at and stamp > self._newest + _BACKWARDS:
            raise UnusableScanError("from before the clock was set back")
        return pose

    def lack(self, name: str) -> str:
        """What scans wait for, such as "no odom -> base_footprint since 2.3 s"; ``name`` is the transform's."""
        silence = time.monotonic() - self._arrived
        ahead = self._asked_for - self._newest
        if silence < _AHEAD < ahead:
            return f"check the clocks: scans are stamped {ahead:.1f} s ahead of odometry"
        return f"no {name} since {silence:.1f} s"
