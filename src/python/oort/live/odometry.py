# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry as it comes in: where the base was at a scan's stamp, or why that is not known (yet)."""

import math
import time
from dataclasses import replace

from oort._core import GyroOdometry, OdometryBuffer
from oort.live.inbox import UnusableScanError
from oort.poses import between, compose
from oort.recording import Pose
from oort.recording.motion import SNAPSHOT, Placement, place

_KEPT = 20.0  # [s] of odometry; scans that come later than that are lost
_BACKWARDS = 1.0  # [s]; a pose or scan that is older than the last one by more says that the clock was set back
_AHEAD = 1.0  # [s]; scans are no more than a message's delay ahead of odometry that flows
_GYRO_PATIENCE = 5.0  # [s] of flowing odometry without a turn of the gyro's; its bias takes 1.5 s to learn


class Odometry:
    """The poses of one frame in odometry's, since the clock was set back last. Not thread-safe."""

    def __init__(self, *, max_extrapolation: float = 0.0, use_gyro: bool = False) -> None:
        """Nothing came so far. ``max_extrapolation`` [s] and ``use_gyro`` are the parameters of that name."""
        self._max_extrapolation = max_extrapolation
        self._gyro = GyroOdometry() if use_gyro else None
        self._buffer = OdometryBuffer(_KEPT)  # as it is reported
        self._turned = OdometryBuffer(_KEPT) if use_gyro else self._buffer  # with the gyro's turns
        self._steps_by_gyro = 0
        self._gyro_turned = math.inf  # by time.monotonic(), when it last did so, or might have begun to [s]
        self._oldest, self._newest = math.inf, -math.inf  # stamps that it covers [s]
        self._last_scan = self._asked_for = -math.inf  # stamps: of the last scan with a pose, and of the last one [s]
        self._arrived = self._set_back_at = self._last_scan_arrived = -math.inf  # by time.monotonic() [s]

    def add(self, stamp: float, pose: Pose) -> bool:
        """Takes a pose; whether it says that the clock was set back, so that all earlier ones are void."""
        silence, self._arrived = time.monotonic() - self._arrived, time.monotonic()
        if silence > _AHEAD:
            self._gyro_turned = self._arrived
        set_back = stamp < self._newest - _BACKWARDS
        if set_back:
            self._buffer = OdometryBuffer(_KEPT)
            self._turned = OdometryBuffer(_KEPT) if self._gyro else self._buffer
            if self._gyro is not None:
                self._gyro.set_back(stamp)
            self._oldest, self._newest = math.inf, -math.inf
            self._set_back_at = self._arrived
        self._buffer.add(stamp, *pose)
        if self._gyro is not None:
            self._gyro.add_odometry(stamp, *pose)
            self._take_turned(self._gyro)
        self._newest = max(self._newest, stamp)
        self._oldest = max(min(self._oldest, stamp), self._newest - _KEPT)
        return set_back

    def add_gyro(self, stamp: float, yaw_rate: float) -> None:
        """Takes a yaw rate of the base [rad/s]; one that odometry says is of the future is left out."""
        flows = time.monotonic() < self._arrived + _AHEAD
        if self._gyro is not None and not (flows and stamp > self._newest + _AHEAD):
            self._gyro.add_gyro(stamp, yaw_rate)
            self._take_turned(self._gyro)

    def _take_turned(self, gyro: GyroOdometry) -> None:
        for time_, x, y, theta in gyro.take():
            self._turned.add(time_, x, y, theta)
        if gyro.steps_by_gyro != self._steps_by_gyro:
            self._steps_by_gyro, self._gyro_turned = gyro.steps_by_gyro, time.monotonic()

    def place(
        self, stamp: float, arrived: float, span: tuple[float, float] = SNAPSHOT, last_resort: bool = False
    ) -> Placement | None:
        """The odometry of a scan, or None as long as it may still come; see `at` and beam_span.

        ``last_resort``: no more odometry will come, so what little is missing is extrapolated.
        """
        ahead = self._max_extrapolation if last_resort else 0.0
        if self.at(stamp, arrived) is None and not (last_resort and stamp > self._newest):
            return None
        if last_resort and self._gyro is not None:
            self._gyro.flush()
            self._take_turned(self._gyro)
        placement = place(lambda time_: self._turned.lookup(time_, ahead), stamp, span)
        if placement is None and stamp + min(span) < self._oldest and arrived < self._arrived:
            raise UnusableScanError("older than the odometry")  # a beam was measured before the stamp
        if placement is None or self._gyro is None:
            return placement and replace(placement, guessed=last_resort)
        reported = self._buffer.lookup(stamp, ahead)
        if reported is None:
            return None
        x, y, theta = compose(placement.odometry, between(reported, (0.0, 0.0, 0.0))).tolist()
        return replace(placement, guessed=True, reported_frame=(x, y, theta))

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

    def gyro_trouble(self) -> str:
        """Why the gyro turns nothing of the odometry that flows, and what to do; empty if it does."""
        now = time.monotonic()
        if self._gyro is None or now > self._arrived + _AHEAD or now < self._gyro_turned + _GYRO_PATIENCE:
            return ""
        if self._gyro.bias is None:
            return "the gyro's bias is not known; let the robot stand still for two seconds"
        return "the gyro's yaw rates do not cover odometry; check the IMU's rate and the clocks"

    def lack(self, name: str) -> str:
        """What scans wait for, such as "no odom -> base_footprint since 2.3 s"; ``name`` is the transform's."""
        silence = time.monotonic() - self._arrived
        ahead = self._asked_for - self._newest
        if silence < _AHEAD < ahead:
            return f"check the clocks: scans are stamped {ahead:.1f} s ahead of odometry"
        return f"no {name} since {silence:.1f} s"
