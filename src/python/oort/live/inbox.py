# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The queue of a live session: scans and calls in the order in which they came."""

import math
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from oort._core import Saved
from oort.live.snapshot import Drawing
from oort.recording import Scan

PATIENCE = 10.0
"""[s] that a scan waits for its odometry"""
PATIENCE_BEFORE_CALL = 2.0
"""[s] that scans wait on when a call has come that wants its turn after them"""
PATIENCE_WHEN_OVERTAKEN = 2.0
"""[s] that a scan waits on when one that came later is ready: odometry comes in order, so its own will hardly come"""

_ASKED = 8  # scans that are not ready, after which the others wait for their turn

UNUSABLE = "unusable"
"""The reason of scans that cannot be mapped for whatever else is wrong with them."""


class UnusableScanError(Exception):
    """Says why a scan will never be mapped; the text is counted, so it names a kind of reason."""


Resolve = Callable[[], Scan | None]
"""Makes the scan once the odometry at its stamp is known; None before. Raises UnusableScanError."""


@dataclass(eq=False, slots=True)
class ScanItem:
    """A scan that came in, perhaps before the odometry at its stamp."""

    resolve: Resolve
    arrived: float
    """[s] time.monotonic()"""
    last_resort: Resolve
    """makes the scan of what is known, when the patience is over"""
    overtaken: float = math.inf
    """[s] time.monotonic() when a scan that came later was ready before it"""
    scan: Scan | None = None
    refused: str = ""
    """the kind of reason why it cannot be mapped"""
    why: str = ""
    """the reason in full"""

    def try_to_resolve(self) -> bool:
        """Whether it is known by now what becomes of the scan."""
        return self._try(self.resolve)

    def give_up(self) -> None:
        """Nothing more will come."""
        if not self._try(self.last_resort):
            self.refuse("no odometry at its stamp")

    def _try(self, resolve: Resolve) -> bool:
        if self.scan is None and not self.refused:
            try:
                self.scan = resolve()
            except UnusableScanError as error:
                self.refuse(str(error))
            except Exception as error:  # whatever is wrong with one scan, the others go on
                self.refuse(UNUSABLE, str(error) or repr(error))
        return self.is_settled

    @property
    def is_settled(self) -> bool:
        """Whether it is known what becomes of the scan."""
        return self.scan is not None or bool(self.refused)

    def refuse(self, reason: str, why: str = "") -> None:
        """It will not be mapped."""
        self.refused, self.why = reason, why or reason


class Answer(NamedTuple):
    """What a call gives, and what its caller may wait for beside it."""

    result: Any
    saves: "Sequence[Future[Saved]]"
    """their failure is the call's"""
    drawing: "Future[Drawing] | None"
    """the map as the call leaves it, where it shows one"""


@dataclass(eq=False, slots=True)
class CallItem:
    """A call that waits for its turn."""

    name: str
    args: Sequence[Any]
    arrived: float
    result: "Future[Answer]" = field(default_factory=Future)


class Inbox:
    """First in, first out; thread-safe. The head stays in the queue, and counts, until it is popped."""

    def __init__(self) -> None:
        """An empty queue."""
        self._changed = threading.Condition()
        self._items: deque[ScanItem | CallItem] = deque()
        self._unresolved: list[ScanItem] = []
        self._turn = 0
        self._calls: deque[CallItem] = deque()
        self._closed: Exception | None = None

    def __len__(self) -> int:
        """Scans and calls that wait, with the one that is being worked on."""
        return len(self._items)

    def add_scan(self, resolve: Resolve, last_resort: Resolve | None = None) -> None:
        """Adds a scan at the end; ``last_resort`` is asked for it when it has waited for too long."""
        item = ScanItem(resolve, time.monotonic(), last_resort or resolve)
        with self._changed:
            if self._closed is not None:
                return
            if not item.try_to_resolve():
                self._unresolved.append(item)
            elif item.scan is not None:
                self._overtake(self._unresolved)
            self._items.append(item)
            self._changed.notify()

    def add_call(self, name: str, args: Sequence[Any]) -> "Future[Answer]":
        """Adds a call at the end; what becomes of it."""
        item = CallItem(name, args, time.monotonic())
        with self._changed:
            if self._closed is not None:
                item.result.set_exception(self._closed)
                return item.result
            self._calls.append(item)  # first: Ctrl-C may come between the two, see pop()
            self._items.append(item)
            self._changed.notify()
        return item.result

    def poke(self) -> None:
        """Says that odometry came: scans that waited for it may be ready."""
        with self._changed:
            if not self._unresolved:
                return
            count = len(self._unresolved)
            # Scans are ready in the order in which they came, with few exceptions. Those are found in turns: if all
            # that wait were asked each time, many of them would cost more time than there is.
            self._turn = (self._turn + _ASKED) % count
            for items in (self._unresolved, self._unresolved[self._turn :]):
                failures = 0
                for item in items:
                    failures += not item.try_to_resolve()
                    if failures == _ASKED:
                        break
            last = max((k for k, item in enumerate(self._unresolved) if item.scan is not None), default=0)
            self._overtake([item for item in self._unresolved[:last] if not item.is_settled])
            self._unresolved = [item for item in self._unresolved if not item.is_settled]
            if len(self._unresolved) < count:
                self._changed.notify()

    @staticmethod
    def _overtake(items: Sequence[ScanItem]) -> None:
        """A scan that came after these is ready."""
        now = time.monotonic()
        for item in reversed(items):
            if item.overtaken < now:
                break  # so are those before it
            item.overtaken = now

    def wake(self) -> None:
        """Makes head() return."""
        with self._changed:
            self._changed.notify()

    def head(self, mapping: bool, timeout: float) -> ScanItem | CallItem | None:
        """The first item once it can be dealt with, or None after a while [s] or when woken.

        Unless ``mapping``, a scan will not be used, so that it need not wait for its odometry.
        """
        with self._changed:
            if not self._ready(mapping):
                self._changed.wait(timeout)
            return self._items[0] if self._ready(mapping) else None

    def pop(self) -> None:
        """The head is done with."""
        with self._changed:
            item = self._items.popleft()
            if isinstance(item, CallItem):
                while self._calls.popleft() is not item:  # those before it were never queued: their callers were ended
                    pass
            elif item in self._unresolved:
                self._unresolved.remove(item)

    def close(self, error: Exception) -> None:
        """Takes no more scans, and refuses the calls that still wait and those to come."""
        with self._changed:
            self._closed = error
            for call in self._calls:
                call.result.set_exception(error)
            self._items.clear()
            self._calls.clear()
            self._unresolved.clear()

    def waiting(self) -> tuple[int, float]:
        """How many scans wait for their odometry, and for how long the first of them has [s]."""
        with self._changed:
            if not self._unresolved:
                return 0, 0.0
            return len(self._unresolved), time.monotonic() - self._unresolved[0].arrived

    def _ready(self, mapping: bool) -> bool:
        if not self._items:
            return False
        item = self._items[0]
        if isinstance(item, CallItem) or not mapping or item.scan is not None or item.refused:
            return True
        now = time.monotonic()
        deadline = min(item.arrived + PATIENCE, item.overtaken + PATIENCE_WHEN_OVERTAKEN)
        if self._calls:
            deadline = min(deadline, max(item.arrived, self._calls[0].arrived) + PATIENCE_BEFORE_CALL)
        if now >= deadline:
            item.give_up()
        return item.scan is not None or bool(item.refused)
