# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""When a replay makes the calls of a drive, and which scans it maps."""

import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from oort.errors import InputError
from oort.events import SCAN, Event, scan_of_entry
from oort.recording import Scan

MakeCall = Callable[[int, Event], None]
"""Makes a call, given with its place in the file."""


class Schedule(Protocol):
    """Asked before each scan of a recording."""

    def take(self, scan: Scan) -> Scan | None:
        """Makes the calls that come before a scan; the scan as it is to be mapped, None if it is not."""

    def finish(self, until: float) -> None:
        """Makes the remaining calls, up to a time [s]."""


@dataclass
class TimedSchedule:
    """Every scan is mapped, and each call is made before the first scan whose stamp reaches its time.

    A call that is out of order does not wait for those before it in the file.
    """

    events: Sequence[Event]
    """in the order of the file"""
    make: MakeCall
    _waiting: deque[tuple[int, Event]] = field(init=False)

    def __post_init__(self) -> None:
        """Sorts by time."""
        self._waiting = deque(sorted(enumerate(self.events), key=lambda entry: entry[1].t))

    def take(self, scan: Scan) -> Scan | None:
        """See Schedule."""
        self.finish(scan.time)
        return scan

    def finish(self, until: float) -> None:
        """See Schedule."""
        while self._waiting and self._waiting[0][1].t <= until:
            self.make(*self._waiting.popleft())


@dataclass
class LoggedSchedule:
    """The log of a live drive: the scans that it lists are mapped and no others, the calls made between as listed."""

    events: Sequence[Event]
    make: MakeCall
    _next: int = 0

    def take(self, scan: Scan) -> Scan | None:
        """See Schedule."""
        self._make_calls()
        if self._next == len(self.events):
            return None
        logged = scan_of_entry(scan, self.events[self._next].args)
        self._next += logged is not None
        return logged

    def finish(self, until: float) -> None:
        """See Schedule. Raises InputError if the log lists scans that the recording has not had."""
        self._make_calls()
        if self._next < len(self.events) and until == math.inf:
            missing = sum(event.call == SCAN for event in self.events[self._next :])
            raise InputError(
                f"event {self._next}: the scan {self.events[self._next].args} is not in the recording, at least not in "
                f"this order ({missing} listed scans were not found); does the log belong to the recording?"
            )

    def _make_calls(self) -> None:
        while self._next < len(self.events) and self.events[self._next].call != SCAN:
            self.make(self._next, self.events[self._next])
            self._next += 1


def make_schedule(events: Sequence[Event], make: MakeCall) -> Schedule:
    """By the log of a live drive if the events are one, which lists scans too; otherwise by time."""
    if any(event.call == SCAN for event in events):
        return LoggedSchedule(events, make)
    return TimedSchedule(events, make)
