# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.replay INPUT``: maps one recorded drive and writes all that came of it into a folder."""

import argparse
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tqdm import tqdm

from oort._core import Parameters
from oort.errors import InputError, OortError
from oort.events import Event, read_events
from oort.parameters import read_parameters
from oort.recording import Pose, Recording, Scan, open_recording
from oort.report import Stopwatch, format_table
from oort.results import Drive, write_results
from oort.session import Session, State
from oort.trajectory import TrajectoryRecorder


@dataclass(frozen=True)
class ReplayOptions:
    """How to replay, beyond the parameters of mapping."""

    map_path: str
    """base path of the map that is saved; empty: none"""
    events: Sequence[Event] = ()
    resume: tuple[str, Pose] | None = None
    """a map to go on with, and about where the sensor is in it at the start"""
    until: float | None = None
    """[s] after the first stamp"""
    quiet: bool = False


@dataclass
class _EventQueue:
    """Hands out the calls that are due, in the order of the file."""

    session: Session
    events: Sequence[Event]
    done: int = field(default=0, init=False)

    def run_until(self, t: float) -> None:
        """Runs all calls up to a scan's stamp."""
        while self.done < len(self.events) and self.events[self.done].t <= t:
            self._run_next()

    def run_all(self) -> None:
        """Runs the calls that are left."""
        while self.done < len(self.events):
            self._run_next()

    def _run_next(self) -> None:
        event = self.events[self.done]
        self.done += 1
        try:
            self.session.call(event.call, event.args)
        except OortError as error:
            raise type(error)(f"event {self.done - 1} ({event.call} at {event.t}): {error}") from error


def replay(recording: Recording, parameters: Parameters, options: ReplayOptions) -> Drive:
    """Runs a whole recording through a session, in the order of the recording, and returns what came of it.

    The map is saved when the drive ends; nothing is written before.
    """
    watch = Stopwatch()
    session = Session(parameters, recording.sensor_on_base)
    recorder = TrajectoryRecorder(recording.sensor_on_base)
    events = _EventQueue(session, options.events)
    times: list[float] = []
    if options.resume is not None:
        session.load(options.resume[0])
        session.resume(options.map_path, options.resume[1])
    elif not any(event.call == "map/start" for event in options.events):
        session.start(options.map_path)
    for scan in _progress(_until(recording.scans(), options.until), recording, options.quiet):
        events.run_until(scan.time)
        started = time.perf_counter()
        result = session.add_scan(scan)
        watch.scan_seconds.append(time.perf_counter() - started)
        recorder.add(scan.stamp, scan.odometry, result)
        times.append(scan.time)
    if not times:
        raise InputError(f"{recording.name}: no scan to map")
    events.run_all()
    if session.state is not State.NOT_MAPPING:
        session.stop()
    return Drive(recording, parameters, session, recorder, watch, max(times) - min(times))


def _until(scans: Iterator[Scan], seconds: float | None) -> Iterator[Scan]:
    first: float | None = None
    for scan in scans:
        first = scan.time if first is None else first
        if seconds is not None and scan.time > first + seconds:
            return
        yield scan


def _progress(scans: Iterator[Scan], recording: Recording, quiet: bool) -> Iterator[Scan]:
    """A bar on a terminal; a plain line now and then elsewhere."""
    if quiet:
        yield from scans
    elif sys.stderr.isatty():
        yield from tqdm(scans, total=recording.num_scans, desc=recording.name, unit=" scans")
    else:
        step = max(1, recording.num_scans // 10)
        for number, scan in enumerate(scans, start=1):
            yield scan
            if number % step == 0:
                print(f"{recording.name}: {number} of {recording.num_scans} scans", file=sys.stderr)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="oort replay",
        description="Maps a recorded drive: a ROS 1 bag, a ROS 2 bag or MCAP, or a CARMEN log (.clf, also .gz, .bz2).",
    )
    parser.add_argument("input", help="the recording")
    parser.add_argument("--params", metavar="FILE", help="parameters (default: the packaged params.json)")
    parser.add_argument("--scan-topic", metavar="TOPIC", help="which LaserScan topic of a bag")
    parser.add_argument("--odom-frame", metavar="FRAME", help="a bag's odometry frame, where it is not called odom")
    parser.add_argument("--max-range", type=float, metavar="M", help="readings beyond this are no return")
    parser.add_argument("--out", metavar="DIR", help="results folder (default: oort-out/<name of the input>)")
    parser.add_argument("--map", metavar="BASE", help="base path of the saved map (default: DIR/map)")
    parser.add_argument("--resume", metavar="BASE", help="a saved map to go on with; needs --pose")
    parser.add_argument(
        "--pose", type=float, nargs=3, metavar=("X", "Y", "THETA"), help="the sensor's pose in it at the start [m, rad]"
    )
    parser.add_argument("--events", metavar="FILE", help="the service calls of the drive, a JSON list of t, call, args")
    parser.add_argument("--until", type=float, metavar="SECONDS", help="stop this long after the first stamp")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    return parser


def _run(args: argparse.Namespace) -> None:
    parameters = read_parameters(args.params)
    events = read_events(args.events) if args.events else []
    recording = open_recording(
        args.input, scan_topic=args.scan_topic, odom_frame=args.odom_frame, max_range=args.max_range
    )
    out = Path(args.out) if args.out else Path("oort-out") / recording.name
    options = ReplayOptions(
        map_path=args.map or str(out.absolute() / "map"),
        events=events,
        resume=(args.resume, tuple(args.pose)) if args.resume else None,
        until=args.until,
        quiet=args.quiet,
    )
    if not args.quiet:
        for note in recording.notes:
            print(f"note: {note}", file=sys.stderr)
    out.mkdir(parents=True, exist_ok=True)
    report = write_results(replay(recording, parameters, options), out)
    if not args.quiet:
        print(format_table(report))
        print(f"wrote {out}: trajectory.tum map.pgm map.yaml map.png graph.g2o report.json; map: {options.map_path}")


def main(argv: Sequence[str] | None = None) -> int:
    """The command line tool; exit code 2 for an input or a call that cannot be used."""
    parser = _parser()
    args = parser.parse_args(argv)
    if (args.resume is None) != (args.pose is None):
        parser.error("--resume and --pose go together: a map needs to know about where the robot starts")
    try:
        _run(args)
    except OortError as error:
        print(f"oort replay: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"oort replay: {error.filename or args.input}: {error.strerror}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
