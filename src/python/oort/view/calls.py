# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The calls that a page may make, checked: what comes over the network is of any shape."""

import math
from typing import Any

from oort.errors import InputError
from oort.inputs import quoted
from oort.live import LiveSession

_WITHOUT_ARGUMENTS = frozenset({"map/pause", "map/resume_from_paused", "map/notify_docked", "map/stop"})
_LONGEST = 200  # characters of a name


def make_call(live: LiveSession, call: Any, args: Any) -> Any:
    """Makes a call by its name, as in an events file; what it returns, as JSON has it.

    Raises InputError for a call that a page may not make, and what the call raises.
    """
    given = args if isinstance(args, dict) else {}
    if isinstance(call, str) and call in _WITHOUT_ARGUMENTS:
        return live.call(call)
    if call == "graph_loc/create":
        return live.places.create(_text(given, "space"), _text(given, "id"))
    if call == "graph_loc/create_points":
        point = [_number(given, "x"), _number(given, "y")]
        return live.call(call, [[_text(given, "space")], [point], [_text(given, "id")]])
    if call == "graph_loc/delete":
        return live.call(call, [_text(given, "space"), _text(given, "id")])
    raise InputError(f"{quoted(call)} is no call that this page may make")


def _text(args: dict[str, Any], name: str) -> str:
    value = args.get(name)
    if not isinstance(value, str) or not 0 < len(value.strip()) <= _LONGEST:
        raise InputError(f"{name}: give a name of 1 to {_LONGEST} characters")
    return value.strip()


def _number(args: dict[str, Any], name: str) -> float:
    value = args.get(name)
    try:
        number = math.nan if isinstance(value, bool) or not isinstance(value, int | float) else float(value)
    except OverflowError:  # a whole number of any length is JSON
        number = math.inf
    if not math.isfinite(number):
        raise InputError(f"{name}: give a number of metres")
    return number
