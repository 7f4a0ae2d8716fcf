# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What a run over a recording costs."""

import gc
import resource
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np


@contextmanager
def without_garbage_pauses() -> Iterator[None]:
    """Has Python's collector leave alone what there is already, such as the scans of a recording that was read.

    It would look through all of it again and again, 27 ms of one scan or another on a log of 17,000.
    """
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()


@dataclass
class Stopwatch:
    """Measures what a replay costs."""

    wall_start: float = field(default_factory=time.perf_counter)
    cpu_start: float = field(default_factory=time.process_time)
    scan_seconds: list[float] = field(default_factory=list)
    """of local SLAM, without what it waited for global SLAM"""
    waited_seconds: list[float] = field(default_factory=list)

    def figures(self, recorded_seconds: float, work_seconds: Mapping[str, float] | None = None) -> dict[str, Any]:
        """Cost so far: of each scan, of the whole, by kind of work if given, and against the recording's length."""
        wall = time.perf_counter() - self.wall_start
        milliseconds = 1e3 * np.array(self.scan_seconds or [0.0])
        by_work = {work: round(seconds, 3) for work, seconds in (work_seconds or {}).items() if work != "waiting"}
        waited = np.array(self.waited_seconds or [0.0])
        p50, p95, p99 = np.percentile(milliseconds, [50, 95, 99])
        return {
            "ms_per_scan": {
                "mean": round(float(milliseconds.mean()), 4),
                "p50": round(float(p50), 4),
                "p95": round(float(p95), 4),
                "p99": round(float(p99), 4),
                "max": round(float(milliseconds.max()), 4),
            },
            "waited": {
                "seconds": round(float(waited.sum()), 3),
                "max_ms": round(1e3 * float(waited.max()), 3),
            },
            "wall_seconds": round(wall, 3),
            "cpu_seconds": round(time.process_time() - self.cpu_start, 3),
            **({"cpu_seconds_by_work": by_work} if by_work else {}),
            "times_real_time": round(recorded_seconds / wall, 1),
            "peak_memory_mb": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, 1),
        }
