# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests of a live session share: one that is driven, and all that it told."""

import time
from collections.abc import Callable

from helpers.scenes import room_scan
from oort._core import Saved
from oort.live import Drawing, Listener, LiveSession, Snapshot
from oort.locations import Pose


class Recorder(Listener):
    """Keeps all that a session tells."""

    def __init__(self) -> None:
        self.drawings: list[Drawing] = []
        self.saves: list[Saved] = []
        self.notes: list[str] = []
        self.troubles: list[str] = []
        self.poses: list[Pose | None] = []
        self.places: list[Snapshot] = []
        self.calls: list[Snapshot] = []

    def scan_taken(self, snapshot: Snapshot) -> None:
        self.poses.append(snapshot.odom_pose)

    def call_made(self, snapshot: Snapshot) -> None:
        self.calls.append(snapshot)

    def places_changed(self, snapshot: Snapshot) -> None:
        self.places.append(snapshot)

    def drawn(self, drawing: Drawing) -> None:
        self.drawings.append(drawing)

    def saved(self, what: Saved) -> None:
        self.saves.append(what)

    def note(self, text: str) -> None:
        self.notes.append(text)

    def trouble(self, text: str) -> None:
        self.troubles.append(text)


def until(condition: Callable[[], bool], timeout: float = 10.0) -> None:
    """Waits until the condition holds, and fails if that takes too long [s]."""
    deadline = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.005)


def drive(live: LiveSession, scans: int = 60, start: float = 0.0) -> None:
    """Sends scans of a drive that begins at the stamp ``start`` [s]."""
    for i in range(scans):
        scan = room_scan(0.01 * i, 0.0, 0.02 * i, start + 0.1 * i)
        live.add_scan(lambda scan=scan: scan)  # type: ignore[misc]


def driven(live: LiveSession, scans: int = 60, start: float = 0.0) -> None:
    """Drives, and returns when all is mapped."""
    drive(live, scans, start)
    until(lambda: len(live.inbox) == 0)
