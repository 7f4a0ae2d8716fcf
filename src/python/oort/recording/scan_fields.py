# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Looks at what the fields of a recording's scans hold: wrong units, missing fields, values that mean no return."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort.errors import InputError
from oort.recording.limits import ScanLimits

_SAMPLE = 400  # scans that are looked at more closely, spread over the recording
_TURN = 1.1 * 2.0 * math.pi  # [rad]; more than a whole turn, with some to spare for lasers that overlap
_FARTHEST = 200.0  # [m]; half of the readings of a laser indoors, or on a robot at all, are nearer
_MANY = 0.002  # of all beams: a value that so many share, and the largest, may be no distance
_VARIETY = 50  # other values that must be there too: else the laser sees one wall, or a test pattern
_JITTER = 0.005  # of the value: some lasers count a little around it
_STRETCHES = 10
_CODES = 3  # so many values may mean no return: some lasers tell why there is none


@dataclass(frozen=True, slots=True)
class Correction:
    """What is taken of a scan's fields instead of what they say."""

    no_return: float = math.inf
    """[m]; readings from here on mean that there was no return"""
    ignores_range_max: bool = False

    def range_max(self, own: float) -> float:
        """The range [m] from which on nothing counts, of a scan that says ``own``."""
        return min(math.inf if self.ignores_range_max else float(own), self.no_return)


def angle_increment(message: Any) -> float:
    """Of a LaserScan, its angle_increment [rad] or, where that is 0, what its ends tell."""
    step, beams = float(message.angle_increment), len(message.ranges)
    return step if step or beams < 2 else (float(message.angle_max) - float(message.angle_min)) / (beams - 1)


class ScanFields:
    """What the scans of one topic hold."""

    def __init__(self, topic: str) -> None:
        """Nothing so far."""
        self._topic = topic
        self._stride = 1
        self._scans = self._undirected = self._without_increment = self._without_range_max = 0
        self._widest = 0.0
        self._range_max = 0.0
        self._sample: list[NDArray[np.float32]] = []

    def add(self, message: Any) -> None:
        """Takes the next LaserScan that has readings."""
        step = angle_increment(message)
        self._undirected += not step and len(message.ranges) > 1
        self._without_increment += not float(message.angle_increment)
        self._widest = max(self._widest, abs(step) * (len(message.ranges) - 1))
        self._without_range_max += not float(message.range_max) > 0.0
        self._range_max = max(self._range_max, float(message.range_max))
        if self._scans % self._stride == 0:
            self._sample.append(np.array(message.ranges, dtype=np.float32))
            if len(self._sample) == 2 * _SAMPLE:
                self._sample, self._stride = self._sample[::2], 2 * self._stride
        self._scans += 1

    @property
    def num_scans(self) -> int:
        """How many scans were taken."""
        return self._scans

    def settle(self, limits: ScanLimits) -> tuple[Correction, list[str]]:
        """What to take instead, and notes. Raises InputError for fields that are of no use."""
        if self._undirected:
            raise InputError(
                f"{self._undirected} scans on {self._topic} have an angle_increment of 0 and angle_min equal to "
                "angle_max, so where their beams point is not known; correct the driver"
            )
        if self._widest > _TURN:
            raise InputError(
                f"a scan on {self._topic} spans {math.degrees(self._widest):.0f} degrees: its angles must be radians, "
                "but look like degrees; correct the driver"
            )
        notes = []
        if self._without_increment:
            notes.append(
                f"{self._without_increment} scans on {self._topic} have an angle_increment of 0: their beams are "
                "spread evenly from angle_min to angle_max"
            )
        unlimited = self._without_range_max == self._scans
        if unlimited:
            notes.append(
                f"range_max is {self._range_max:g} on {self._topic}, which is no range: every reading counts; "
                "--max-range sets how far the laser sees"
            )
        values = np.concatenate([*self._sample, np.zeros(0, np.float32)])
        own = math.inf if unlimited else self._range_max
        self._check_units(values, own)
        farthest = limits.range_max(own)
        code, told = find_no_return([ranges[ranges < farthest] for ranges in self._sample], len(values))
        return Correction(code, unlimited), notes + told

    def _check_units(self, values: NDArray[np.float32], range_max: float) -> None:
        readings = values[np.isfinite(values) & (values > 0.0)]
        if not len(readings):
            return
        median = float(np.median(readings))
        beyond = readings >= range_max
        if median > _FARTHEST:
            raise InputError(
                f"half of the readings on {self._topic} are beyond {median:.0f}: ranges must be metres, but look like "
                "millimetres; correct the driver"
            )
        if beyond.mean() > 0.99 and len(np.unique(readings[beyond])) > 10:  # a value for no return is one or few
            raise InputError(
                f"nearly all readings on {self._topic} are beyond their range_max of {range_max:g} m (half of them "
                f"beyond {median:g}), so none counts: one of the two is wrong; correct the driver"
            )


def find_no_return(scans: Sequence[NDArray[np.float32]], beams: int) -> tuple[float, list[str]]:
    """The least value that means no return, in the readings within limits of scans with so many beams; and a note.

    Infinity if there is none. Such a value is the largest; many beams share exactly it, all along the drive, and few
    come near: a far wall is seen with noise, for a while, and with walls before it.
    """
    values = np.concatenate([*scans, np.zeros(0, np.float32)])
    found, counts = np.unique(values[np.isfinite(values) & (values > 0.0)], return_counts=True)
    least, shared = math.inf, 0
    codes: list[float] = []
    while len(codes) < _CODES and len(found) > _VARIETY:
        common = np.flatnonzero(counts >= _MANY * beams)
        if not len(common):
            break
        top = found >= found[common[-1]] * (1.0 - _JITTER)
        peak = int(np.argmax(np.where(top, counts, 0)))
        code = float(found[peak])
        near = np.abs(found - code) <= _JITTER * code
        around, beyond = int(counts[near].sum()), int(counts[found > code * (1.0 + _JITTER)].sum())
        before = int(counts[(found >= 0.9 * code) & ~near & (found < code)].sum())
        exact = float(counts[peak]) >= 0.4 * around
        if not exact or beyond > 0.05 * around or 3 * before > around or not _throughout(scans, code):
            break
        least = code * (1.0 - _JITTER)
        codes.append(code)
        shared += around + beyond
        found, counts = found[found < least], counts[found < least]
    if not codes:
        return math.inf, []
    listed = ", ".join(f"{code:g}" for code in codes)
    return least, [
        f"{shared / len(scans):.1f} readings a scan are about {listed} m, the largest: taken for no return; "
        "--max-range sets another limit"
    ]


def _throughout(scans: Sequence[NDArray[np.float32]], code: float) -> bool:
    """Whether a value comes in at least half of ten stretches of the drive."""
    if len(scans) < 2 * _STRETCHES:
        return False
    there = [bool((np.abs(scan - code) <= _JITTER * code).any()) for scan in scans]
    return sum(bool(stretch.any()) for stretch in np.array_split(np.array(there), _STRETCHES)) >= _STRETCHES // 2
