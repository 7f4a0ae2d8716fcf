# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The events file: the service calls of a drive, so that it can be replayed."""

import contextlib
import errno
import json
import os
import stat
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from oort.errors import InputError
from oort.inputs import quoted, read_text
from oort.recording import Pose, Scan

SCAN = "scan"
"""The call's name in an entry that stands for a scan."""


@dataclass(frozen=True)
class Event:
    """One service call: it takes effect before the first scan, in recording order, whose stamp reaches ``t``."""

    t: float
    """[s]"""
    call: str
    """Name under the node, such as map/notify_docked; or SCAN: here the scan was mapped that scan_entry() describes."""
    args: list[Any] = field(default_factory=list)


def read_events(path: str | Path) -> list[Event]:
    """Reads a JSON list of ``{"t": seconds, "call": "map/notify_docked", "args": []}``, in the file's order.

    Raises InputError naming the file and the entry that is wrong.
    """
    try:
        entries = json.loads(read_text(Path(path)))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not JSON: {error}; an events file is a list of t, call, args objects") from error
    if not isinstance(entries, list):
        raise InputError(f"{path}: an events file is a JSON list of objects with t, call and args")
    return [_event(path, number, entry) for number, entry in enumerate(entries)]


def _event(path: str | Path, number: int, entry: Any) -> Event:
    where = f"{path}: event {number}"
    if not isinstance(entry, dict) or not {"t", "call"} <= entry.keys() <= {"t", "call", "args"}:
        raise InputError(f'{where}: expected an object with "t", "call" and maybe "args", got {quoted(entry)}')
    t, call, args = entry["t"], entry["call"], entry.get("args", [])
    if isinstance(t, bool) or not isinstance(t, int | float) or not abs(t) <= sys.float_info.max:
        raise InputError(f'{where}: "t" must be a finite number of seconds, got {quoted(t)}')
    if not isinstance(call, str) or not isinstance(args, list):
        raise InputError(f'{where}: "call" must be a string and "args" a list')
    return Event(float(t), call, args)


def scan_entry(scan: Scan) -> list[Any]:
    """The arguments of a scan's entry: its stamp and, where a replay might find other odometry, the one it had."""
    return [scan.stamp, scan.odometry, scan.sweep] if scan.guessed else [scan.stamp]


def scan_of_entry(scan: Scan, args: Sequence[Any]) -> Scan | None:
    """A recording's scan as it was mapped by an entry's arguments; None if they are of another scan.

    Raises InputError if they cannot be.
    """
    if list(args[:1]) != [scan.stamp]:
        return None
    if len(args) == 1:
        return scan
    try:
        _, odometry, sweep = args
        ends = None if sweep is None else (_pose(sweep[0]), _pose(sweep[1]))
        return replace(scan, odometry=_pose(odometry), sweep=ends)
    except (TypeError, ValueError, LookupError, OverflowError) as error:
        raise InputError(f"the entry of the scan {scan.stamp} cannot be: {quoted(list(args[1:]))}") from error


def _pose(values: Sequence[float]) -> Pose:
    x, y, theta = map(float, values)
    return x, y, theta


class EventLog:
    """Writes an events file as things happen; after each entry the file is whole."""

    _END = b"\n]\n"

    def __init__(self, path: str | Path) -> None:
        """Begins the file anew; one that is there becomes ``path`` with .1. Raises InputError if that fails."""
        self._path = path
        self._size = 1  # without the end
        try:
            if os.path.isfile(path):
                os.replace(path, f"{path}.1")
            flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC | os.O_NONBLOCK  # a pipe makes nobody wait
            self._file = os.open(path, flags, 0o666)
            if not stat.S_ISREG(os.fstat(self._file).st_mode):
                os.close(self._file)
                raise InputError(f"{path}: the events log cannot be a device or a pipe; give a file")
            os.write(self._file, b"[" + self._END)
        except (OSError, ValueError) as error:
            why = error.strerror if isinstance(error, OSError) else error
            raise InputError(f"{path}: the events log cannot be written: {why}") from error

    def add(self, t: float, call: str, args: Sequence[Any]) -> None:
        """Adds an entry. Raises InputError if that fails; the file then ends with the entry before."""
        entry = json.dumps({"t": t, "call": call, "args": list(args)}).encode()
        text = (b"\n" if self._size == 1 else b",\n") + entry
        try:
            if os.pwrite(self._file, text + self._END, self._size) < len(text + self._END):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        except OSError as error:
            with contextlib.suppress(OSError):
                os.pwrite(self._file, self._END, self._size)  # where something has been, there is room
                os.ftruncate(self._file, self._size + len(self._END))
            raise InputError(f"{self._path}: an entry of the events log is lost: {error.strerror}") from error
        self._size += len(text)

    def close(self) -> None:
        """Closes the file."""
        os.close(self._file)
