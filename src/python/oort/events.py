# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The events file: the service calls of a drive, so that it can be replayed."""

import json
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from oort.errors import InputError


@dataclass(frozen=True)
class Event:
    """One service call: it takes effect before the first scan, in recording order, whose stamp reaches ``t``."""

    t: float
    """[s]"""
    call: str
    """Name under the node, such as map/notify_docked."""
    args: list[Any] = field(default_factory=list)


def read_events(path: str | Path) -> list[Event]:
    """Reads a JSON list of ``{"t": seconds, "call": "map/notify_docked", "args": []}``, in the file's order.

    Raises InputError naming the file and the entry that is wrong.
    """
    try:
        entries = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot read the events: {error.strerror}") from error
    except ValueError as error:
        raise InputError(f"{path}: not JSON: {error}; an events file is a list of t, call, args objects") from error
    if not isinstance(entries, list):
        raise InputError(f"{path}: an events file is a JSON list of objects with t, call and args")
    return [_event(path, number, entry) for number, entry in enumerate(entries)]


def _event(path: str | Path, number: int, entry: Any) -> Event:
    where = f"{path}: event {number}"
    if not isinstance(entry, dict) or not {"t", "call"} <= entry.keys() <= {"t", "call", "args"}:
        raise InputError(f'{where}: expected an object with "t", "call" and maybe "args", got {json.dumps(entry)}')
    t, call, args = entry["t"], entry["call"], entry.get("args", [])
    if isinstance(t, bool) or not isinstance(t, int | float) or not abs(t) <= sys.float_info.max:
        raise InputError(f'{where}: "t" must be a finite number of seconds, got {json.dumps(t)}')
    if not isinstance(call, str) or not isinstance(args, list):
        raise InputError(f'{where}: "call" must be a string and "args" a list')
    return Event(float(t), call, args)
