# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Signs of life while a recording is worked through."""

import sys
import time
from collections.abc import Iterator

from tqdm import tqdm

from oort.recording import Recording, Scan

_SILENCE = 10.0  # [s] without a line, at most


def time_left(started: float, done: int, total: int) -> str:
    """``, 12 s left``, by what was done since ``started`` (time.monotonic()); empty once all is done or nothing is."""
    if not 0 < done < total:
        return ""
    return f", {(time.monotonic() - started) / done * (total - done):.0f} s left"


def scans_with_progress(recording: Recording, quiet: bool) -> Iterator[Scan]:
    """The scans of a recording, with signs of life on standard error unless quiet."""
    return with_progress(recording.scans(), recording, quiet)


def with_progress(scans: Iterator[Scan], recording: Recording, quiet: bool) -> Iterator[Scan]:
    """Passes scans on with signs of life on standard error: a bar on a terminal, else a plain line now and then."""
    if quiet:
        yield from scans
    elif sys.stderr.isatty():
        yield from tqdm(scans, total=recording.num_scans, desc=recording.name, unit=" scans")
    else:
        step = max(1, recording.num_scans // 10)
        told = started = time.monotonic()
        for number, scan in enumerate(scans, start=1):
            yield scan
            if number % step == 0 or time.monotonic() > told + _SILENCE:
                told = time.monotonic()
                left = time_left(started, number, recording.num_scans)
                print(f"{recording.name}: {number} of {recording.num_scans} scans{left}", file=sys.stderr)
