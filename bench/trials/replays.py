# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A recording through a session, with a look at each scan: what it cost and where the robot was thought to be then."""

import math
import resource
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from oort import Parameters
from oort._core import SWITCH_ON
from oort.events import Event
from oort.offline.results import Drive
from oort.offline.schedule import TimedSchedule
from oort.offline.trajectory import TrajectoryRecorder
from oort.poses import Array, between, compose
from oort.recording import Recording
from oort.report.stopwatch import Stopwatch, without_garbage_pauses
from oort.session import Session

LIMIT = 5.0  # ms that a scan may cost outside the solver


@dataclass(frozen=True, eq=False)
class Replayed:
    """A replayed drive, for n scans."""

    drive: Drive
    """as oort.results writes it"""
    T_map_base: Array
    """(n, 3) at the final solution"""
    T_map_base_then: Array
    """(n, 3) as it was told right after each scan"""
    T_map_mark_then: Array
    """(n, 3) where a place of the map was then that the base was told to be at just before the mark; NaN before"""
    seconds: Array
    """(n,) of CPU that each scan took: what else the machine does counts for nothing"""
    closes: np.ndarray[Any, np.dtype[np.bool_]]
    """(n,) whether the scan tried loop closures or solved the graph"""
    solving: Array
    """(n,) of those seconds, what the solver took"""
    states: tuple[str, ...]
    """(n,) how well the place was known, as it was told right after each scan"""


@without_garbage_pauses()
def replay(
    recording: Recording, parameters: Parameters, events: Sequence[Event] = (), mark: float = math.inf
) -> Replayed:
    """Maps a recording as oort.replay does and returns what came of it; ``mark`` is a time [s]."""
    watch = Stopwatch()
    session = Session(parameters, recording.sensor_on_base)
    recorder = TrajectoryRecorder(recording.sensor_on_base)

    def call(_: int, event: Event) -> None:
        session.call(event.call, event.args)
        recorder.follow(session.mapper.take_renumbering())

    schedule = TimedSchedule(events, call)
    then: list[tuple[float, float, float]] = []
    closes: list[bool] = []
    solving: list[float] = []
    states: list[str] = []
    times: list[float] = []
    marks: list[tuple[float, float, float]] = []
    unmarked = (math.nan,) * 3
    solved = 0.0
    session.start()
    for scan in recording.scans():
        schedule.take(scan)
        if scan.time >= mark and session.mapper.has_pose:
            session.mapper.create_location("bench", "mark", session.mapper.sensor_pose)
            mark = math.inf
        started = time.thread_time()
        result = session.add_scan(scan)
        watch.scan_seconds.append(time.thread_time() - started)
        recorder.follow(session.mapper.take_renumbering())
        recorder.add(scan.stamp, scan.odometry, result)
        closes.append(result is not None and result.corrected)
        states.append("" if result is None else result.tracking)
        before = solved
        if result is not None and result.corrected:
            solved = session.mapper.work_seconds["solving"]
        solving.append(solved - before)
        then.append(session.mapper.sensor_pose if session.mapper.has_pose else (math.nan,) * 3)
        marks.append(session.mapper.locate("bench", "mark") or unmarked)
        times.append(scan.time)
    schedule.finish(math.inf)
    session.stop()
    recorder.follow(session.mapper.take_renumbering())
    T_sensor_base = between(recording.sensor_on_base, np.zeros(3))
    return Replayed(
        Drive(recording, parameters, session, recorder, watch, max(times) - min(times)),
        recorder.base_poses(session.map),
        compose(np.array(then), T_sensor_base),
        compose(np.array(marks), T_sensor_base),
        np.array(watch.scan_seconds),
        np.array(closes),
        np.array(solving),
        tuple(states),
    )


def cost(replayed: Replayed) -> dict[str, float]:
    """CPU seconds and peak memory of this process so far, and ms per scan: of all, without the time in the solver, and
    of those that neither close loops nor solve."""
    ms, closes = 1e3 * replayed.seconds, replayed.closes
    others = ms[~closes]
    unsolved = ms - 1e3 * replayed.solving
    work = replayed.drive.session.mapper.work_seconds
    return {
        "cpu_s": time.process_time(),
        "memory_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        "ms_mean": float(ms.mean()),
        "ms_p50": float(np.percentile(ms, 50)),
        "ms_p99": float(np.percentile(ms, 99)),
        "ms_max": float(ms.max()),
        "ms_p99_no_solving": float(np.percentile(unsolved, 99)),
        "ms_max_no_solving": float(unsolved.max()),
        "over_5_ms_no_solving": float((unsolved > LIMIT).sum()),
        **{f"seconds_{kind}": seconds for kind, seconds in work.items()},
        "ms_p99_no_closing": float(np.percentile(others, 99)),
        "ms_max_no_closing": float(others.max()),
        "seconds_no_closing": float(others.sum() / 1e3),
        "seconds_closing": float(ms[closes].sum() / 1e3),
    }


def counts(replayed: Replayed) -> dict[str, float]:
    """What the mapper counted."""
    s = replayed.drive.session.mapper.statistics
    figures: dict[str, float] = {key: s[key] for key in ("scans", "nodes", "odometry_links", "solves")}
    figures |= {f"rejected_{reason}": count for reason, count in s["match_rejections"].items()}
    for kind in ("loops", "docks"):
        figures |= {f"{kind}_tried": s[kind]["tried"], f"{kind}_accepted": s[kind]["accepted"]}
        figures |= {f"{kind}_rejected_{reason}": count for reason, count in s[kind]["rejected"].items()}
    switches = replayed.drive.session.map.switchable_edges["switch"]
    return figures | {
        "closures_on": float((switches >= SWITCH_ON).sum()),
        "closures_off": float((switches < SWITCH_ON).sum()),
    }
