# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The figures of a live session: what came, what became of it, and how long that took."""

import enum
import time
from collections import Counter

from oort._core import ScanResult, TrackingState
from oort.live.window import Rate, Window
from oort.recording import Scan
from oort.session import State

_QUIET = 10.0  # [s] between two words on one reason
_OF_LATE = 5.0  # [s]
_SILENCE = 1.0  # [s] without a scan: none are arriving
_NEVER = float("-inf")


class Tracking(enum.StrEnum):
    """How well the robot's place is known: what the last scan's result says of it (docs/tracking.md), or idle."""

    IDLE = "idle"
    """nothing is being mapped"""
    TRACKING = TrackingState.TRACKING.value
    UNCERTAIN = TrackingState.UNCERTAIN.value
    LOST = TrackingState.LOST.value


class Drops:
    """Scans that were not mapped though they should have been, by reason."""

    def __init__(self) -> None:
        """None so far."""
        self.counts: Counter[str] = Counter()
        self._last: dict[str, float] = {}
        self._told: dict[str, tuple[float, int]] = {}  # when, and how many there were then

    def add(self, reason: str, why: str) -> str:
        """Counts a scan; ``why`` is its reason in full. What to tell of it: nothing shortly after the last word."""
        now = time.monotonic()
        self.counts[reason] += 1
        self._last[reason] = now
        told_at, told = self._told.get(reason, (_NEVER, 0))
        if now < told_at + _QUIET:
            return ""
        self._told[reason] = now, self.counts[reason]
        scans = self.counts[reason] - told
        return f"{scans} scans were left out: {why}" if scans > 1 else f"a scan was left out: {why}"

    def of_late(self) -> list[str]:
        """The reasons of the last seconds."""
        now = time.monotonic()
        return sorted(reason for reason, last in list(self._last.items()) if now < last + _OF_LATE)


class Figures:
    """What diagnostics tell. Written by the threads that bring scans and map them; anyone reads."""

    def __init__(self) -> None:
        """Nothing came so far."""
        self.scans_arrived = 0
        self.scans_mapped = 0
        self.drops = Drops()
        self.scans_while_paused = 0
        """came while mapping was paused, and were not mapped, as was asked"""
        self.clock_jumps = 0
        """how often the scans' clock was set back"""
        self.milliseconds = Window()
        """to map a scan"""
        self.delays = Window()
        """[ms] from a scan's arrival until it is mapped and told"""
        self.last_result: ScanResult | None = None
        self.last_scan: Scan | None = None
        """of the main laser"""
        self.last_stamp = ""
        """of its scan, exact: see Scan"""
        self._arrivals = Rate()
        self._last_arrival = _NEVER

    def arrived(self) -> None:
        """A scan came."""
        self.scans_arrived += 1
        self._last_arrival = time.monotonic()
        self._arrivals.add(self._last_arrival)

    def mapped(self, result: ScanResult | None, seconds: float, scan: Scan | None = None) -> None:
        """A scan was mapped, which took so long [s]."""
        self.scans_mapped += 1
        self.milliseconds.add(1e3 * seconds)
        self.last_result, self.last_scan = result, scan

    def forget(self) -> None:
        """The map that the last scans were mapped into is gone."""
        self.last_result = None

    @property
    def scan_rate(self) -> float:
        """How often scans came of late [1/s]."""
        return self._arrivals.hertz(time.monotonic())

    @property
    def seconds_without_scan(self) -> float:
        """Since the last scan arrived [s]; inf if none did."""
        return time.monotonic() - self._last_arrival

    @property
    def scans_arrive(self) -> bool:
        """Whether one did of late."""
        return self.seconds_without_scan <= _SILENCE

    def tracking(self, state: State) -> Tracking:
        """How well the robot's place is known."""
        if state is not State.MAPPING or self.last_result is None:
            return Tracking.IDLE
        return Tracking(self.last_result.tracking)
