# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Maps a recorded drive: a recording and its calls through a session."""

import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from oort._core import Parameters, ScanResult
from oort.errors import InputError, OortError
from oort.evaluation.attempts import MOST
from oort.events import Event
from oort.naming import service
from oort.offline.progress import with_progress
from oort.offline.results import Drive
from oort.offline.schedule import make_schedule
from oort.offline.trajectory import TrajectoryRecorder
from oort.recording import Pose, Recording, Scan
from oort.report.scan_log import ScanLog
from oort.report.stopwatch import Stopwatch
from oort.session import Session


@dataclass(frozen=True)
class ReplayOptions:
    """How to replay, beyond the parameters of mapping."""

    events: Sequence[Event] = ()
    resume: tuple[str, Pose] | None = None
    """a map to go on with, and about where the sensor is in it at the start"""
    ignore_checksum: bool = False
    """whether the map to go on with is read though its checksums do not fit"""
    until: float | None = None
    """[s] after the first stamp"""
    quiet: bool = False
    keep_attempts: bool = False
    """whether to tell of each attempt to close a loop"""


@dataclass(frozen=True)
class _Caller:
    """Makes the calls of a drive. None of them saves: a live robot's log names the live robot's map."""

    session: Session
    recorder: TrajectoryRecorder

    def __call__(self, number: int, event: Event) -> None:
        try:
            self.session.call(event.call, event.args)
        except OortError as error:
            raise type(error)(f"event {number} ({event.call} at {event.t}): {error}") from error
        self.session.save_to("")
        if event.call in ("map/clear", "map/load", "map/reject"):
            self.recorder.forget_nodes()
        self.recorder.follow(self.session.mapper.take_renumbering())


def replay(
    recording: Recording,
    parameters: Parameters | None = None,
    options: ReplayOptions = ReplayOptions(quiet=True),
) -> Drive:
    """Runs a whole recording through a session, in the order of the recording, and returns what came of it.

    ``parameters`` are the defaults if not given. Nothing is written: write_results() does that. Raises InputError if no
    scan could be mapped.
    """
    parameters = Parameters() if parameters is None else parameters
    if recording.without_odometry:
        parameters = parameters.copy()
        parameters.set("use_odometry", False)
    watch = Stopwatch()
    session = Session(parameters, recording.sensor_on_base, naming=service, keep_attempts=MOST)
    recorder = TrajectoryRecorder(recording.sensor_on_base)
    schedule = make_schedule(options.events, _Caller(session, recorder))
    log = ScanLog()
    learned = math.nan, math.nan
    if options.resume is not None:
        session.load(options.resume[0], ignore_checksum=options.ignore_checksum)
        session.resume("", options.resume[1])
    elif not any(event.call == "map/start" for event in options.events):
        session.start()
    for scan in with_progress(_until(recording.scans(), options.until), recording, options.quiet):
        result = None
        mapped = schedule.take(scan)
        if scan.mount is not None:  # it joins the next scan of the main laser
            if mapped is not None:
                session.add_scan(mapped)
            continue
        if mapped is not None:
            result = _map_timed(session, mapped, watch)
            recorder.follow(session.mapper.take_renumbering())
            if result is not None and result.node_id is not None:  # gathering all statistics costs 3 % of a scan
                scale = session.mapper.statistics["odometry_scale"]
                learned = scale["translation"], scale["rotation"]
            log.add(scan.time, result, watch.scan_seconds[-1], watch.waited_seconds[-1], learned)
            session.observe(mapped)
        else:
            log.add(scan.time, None)
        recorder.add(scan.stamp, (mapped or scan).odometry, result)
    if not log.times:
        raise InputError(f"{recording.name}: no scan to map")
    schedule.finish(math.inf if options.until is None else log.times[0] + options.until)
    session.stop()
    recorder.follow(session.mapper.take_renumbering())
    if session.mapper.num_nodes == 0:
        raise InputError(
            f"{recording.name}: no scan made it into a map: each has fewer than "
            f"{parameters.get('min_pointcloud_size')} returns, or the map was cleared or never started"
        )
    duration = max(log.times) - min(log.times)
    return Drive(recording, parameters, session, recorder, watch, duration, options.keep_attempts, log)


def _map_timed(session: Session, scan: Scan, watch: Stopwatch) -> ScanResult | None:
    """Maps a scan, and notes what it took and what of it was waiting for the global lane."""
    started, waited = time.perf_counter(), session.mapper.work_seconds["waiting"]
    result = session.add_scan(scan)
    waited = session.mapper.work_seconds["waiting"] - waited
    watch.scan_seconds.append(time.perf_counter() - started - waited)
    watch.waited_seconds.append(waited)
    return result


def _until(scans: Iterator[Scan], seconds: float | None) -> Iterator[Scan]:
    first: float | None = None
    for scan in scans:
        first = scan.time if first is None else first
        if seconds is not None and scan.time > first + seconds:
            return
        yield scan
