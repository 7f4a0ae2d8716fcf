# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Saves a map over another one while each file call fails in turn: run by test_storage_faults.py under faulty_files.c.

Prints how many failures there were, by kind. An assertion fails where a map is lost or a failed save is told as done.
"""

import ctypes
import errno
import json
import os
import sys
from collections import Counter
from pathlib import Path

from oort import Map, MapFileError, load_map, save_map

SHORT = 0
ERRORS = {"EIO": errno.EIO, "ENOSPC": errno.ENOSPC, "EROFS": errno.EROFS, "EINTR": errno.EINTR, "short": SHORT}


def _is(map_: Map, other: Map) -> bool:
    return len(map_) == len(other)


def _fail_each(base: str, old: Map, new: Map, error: int, onwards: bool) -> tuple[int, int]:
    """How many calls failed, and how many saves were done nevertheless."""
    layer = ctypes.CDLL(None)
    folder = os.path.dirname(base).encode()
    saved = 0
    for calls in range(1000):
        save_map(base, old)
        layer.faulty_files_arm(folder, calls, error, onwards)
        try:
            save_map(base, new)
            told = True
        except MapFileError:
            told = False
        if not layer.faulty_files_disarm():
            return calls, saved
        saved += told
        found = load_map(base)
        assert _is(found, new) or (not told and _is(found, old)), f"call {calls}, error {error}: the map is lost"
        assert not list(Path(base).parent.glob("*.new")), "loading completes what was begun"
    raise AssertionError("it never ends")


if __name__ == "__main__":
    base, old, new = sys.argv[1], load_map(sys.argv[2]), load_map(sys.argv[3])
    counts: Counter[str] = Counter()
    for name, error in ERRORS.items():
        for onwards in (False, True):
            failures, _ = _fail_each(base, old, new, error, onwards)
            counts[f"{name}{', and all after it' if onwards else ''}"] = failures
    print(json.dumps(counts))
