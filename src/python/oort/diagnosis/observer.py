# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Watches a drive beside its mapping: how scans say that the sensor moved, and how odometry does."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from oort._core import ReferenceScan
from oort.poses import between, compose
from oort.recording.types import Pose, Scan

_EVERY = 5  # scans between samples, at first
# Turns are rare in halls: of three made-up drives of 5 minutes fewer than 15 turning samples were taken otherwise.
_TURNING = 0.02  # [rad] between two scans by odometry
_EVERY_TURN, _TURNS = 2, 60  # scans between samples that turn, for so many samples
_STANDING = 20  # scans between samples while odometry stands
_SAMPLES = 250  # that are taken so often; then ten times as rarely
_RARER = 10
_MOVED = (0.005, 0.005)  # [m], [rad] between two scans
# No robot gets too far in 0.4 s to lay one scan on the other. Some logs have a scan a second; there odometry tells
# whether it did, unless it is wrong, and then the scans do not fit.
_AT_ONCE, _LONGEST = 0.4, 2.0  # [s] between two scans,
_FARTHEST = (0.5, 0.5)  # [m], [rad] by odometry in more than the first of these
# Chosen on fr-clinic (docs/troubles.md), checked on halls, homes and recordings.
_OVERLAP, _MISFIT = 0.5, 0.03**2  # share of the points, [m^2] of these
_KEPT = 40_000  # scans whose odometry is remembered, and 1/20 as many samples


class Sample(NamedTuple):
    """How the sensor moved from one scan to the next."""

    begin: float
    """[s], stamps of the two scans"""
    end: float
    odometry: Pose
    """T_before_after by odometry"""
    scans: Pose
    """by the scans alone"""
    misfit: float
    """mean squared distance that is left where the scans overlap [m^2]"""
    inlier_ratio: float
    degenerate: bool
    """whether the scans leave a direction open"""

    @property
    def fits(self) -> bool:
        """Whether most of one scan lies on the other, and closely."""
        return self.inlier_ratio >= _OVERLAP and self.misfit <= _MISFIT


class Observer:
    """Takes the scans of a drive in order. What it costs is bounded: a few hundred pairs of scans are compared."""

    def __init__(self, sensor_on_base: Pose) -> None:
        """Nothing so far; ``sensor_on_base`` is T_base_sensor."""
        self._mount = sensor_on_base
        self._before: Scan | None = None
        self._since = 0
        self._taken = 0
        self._turns = 0
        self.samples: list[Sample] = []
        self.stamps: list[float] = []
        """of all scans [s]"""
        self.odometry: list[Pose] = []
        """T_odom_base at all scans"""
        self.after_pauses: set[float] = set()
        """stamps of scans before which none was wanted [s]"""
        self._paused = False

    def add(self, scan: Scan) -> None:
        """Takes the next scan."""
        before, self._before = self._before, scan
        if self._paused:
            self.after_pauses.add(scan.time)
            self._paused, before = False, None
        self.stamps.append(scan.time)
        self.odometry.append(scan.odometry)
        self._since += 1
        if before is not None and self._is_due(before, scan):
            self._since = 0
            self._taken += 1
            self._compare(before, scan)
        if len(self.stamps) > _KEPT:
            del self.stamps[: _KEPT // 2], self.odometry[: _KEPT // 2]
            self.samples = [sample for sample in self.samples if sample.begin >= self.stamps[0]]
            self.after_pauses = {stamp for stamp in self.after_pauses if stamp >= self.stamps[0]}

    def pause(self) -> None:
        """Mapping is paused before the next scan: that none came since the last one is no fault."""
        self._paused = True

    def _is_due(self, before: Scan, scan: Scan) -> bool:
        apart = scan.time - before.time
        x, y, theta = between(before.odometry, scan.odometry).tolist()
        near = max(abs(x), abs(y)) < _FARTHEST[0] and abs(theta) < _FARTHEST[1]
        if not 0.0 < apart <= (_LONGEST if near else _AT_ONCE):
            return False
        if np.array_equal(before.ranges, scan.ranges, equal_nan=True):
            return False  # sent again, perhaps: it tells of no motion
        if abs(theta) > _TURNING and self._turns < _TURNS and self._since >= _EVERY_TURN:
            self._turns += 1
            return True
        stands = max(abs(x), abs(y)) < _MOVED[0] and abs(theta) < _MOVED[1]
        rarer = _RARER if self._taken >= _SAMPLES else 1
        return self._since >= (_STANDING if stands else _EVERY) * rarer

    def _compare(self, before: Scan, scan: Scan) -> None:
        moved: NDArray[np.float64] = between(compose(before.odometry, self._mount), compose(scan.odometry, self._mount))
        x, y, theta = moved.tolist()
        guesses = [(0.0, 0.0, 0.0), (x, y, theta), (x, y, -theta), (-x, -y, theta)]
        pose, misfit, inlier_ratio, degenerate = ReferenceScan(*before.readings).align(*scan.readings, guesses)
        self.samples.append(Sample(before.time, scan.time, (x, y, theta), pose, misfit, inlier_ratio, degenerate))


def columns(samples: Sequence[Sample]) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Motions (n, 3) by odometry and by scans, and whether a direction is open, of the samples that fit well."""
    good = [sample for sample in samples if sample.fits]
    odometry = np.array([sample.odometry for sample in good], dtype=np.float64).reshape(-1, 3)
    scans = np.array([sample.scans for sample in good], dtype=np.float64).reshape(-1, 3)
    return odometry, scans, np.array([sample.degenerate for sample in good], dtype=np.bool_)
