# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.replay INPUT``: maps one recorded drive and writes all that came of it into a folder."""

import argparse
import math
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from tqdm import tqdm

from oort._core import Parameters, load_map, normalise_map_path
from oort.attempts import MOST
from oort.errors import InputError, OortError
from oort.events import Event, read_events
from oort.localization import find_start
from oort.parameters import read_parameters
from oort.recording import Pose, Recording, Scan
from oort.recording.arguments import add_recording_arguments, recording_of
from oort.report import Stopwatch, format_table
from oort.results import Drive, write_results
from oort.schedule import make_schedule
from oort.session import Session
from oort.tool import add_pose_argument, parse_arguments, run_tool
from oort.trajectory import TrajectoryRecorder


@dataclass(frozen=True)
class ReplayOptions:
    """How to replay, beyond the parameters of mapping."""

    events: Sequence[Event] = ()
    resume: tuple[str, Pose] | None = None
    """a map to go on with, and about where the sensor is in it at the start"""
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
        if event.call in ("map/clear", "map/load"):
            self.recorder.forget_nodes()


def replay(recording: Recording, parameters: Parameters, options: ReplayOptions) -> Drive:
    """Runs a whole recording through a session, in the order of the recording, and returns what came of it.

    Nothing is written: write_results() does that. Raises InputError if no scan could be mapped.
    """
    watch = Stopwatch()
    session = Session(parameters, recording.sensor_on_base, keep_attempts=MOST)
    recorder = TrajectoryRecorder(recording.sensor_on_base)
    schedule = make_schedule(options.events, _Caller(session, recorder))
    times: list[float] = []
    scan_hits: list[float] = []
    if options.resume is not None:
        session.load(options.resume[0])
        session.resume("", options.resume[1])
    elif not any(event.call == "map/start" for event in options.events):
        session.start()
    for scan in _progress(_until(recording.scans(), options.until), recording, options.quiet):
        result = None
        mapped = schedule.take(scan)
        if mapped is not None:
            started, waited = time.perf_counter(), session.mapper.work_seconds["waiting"]
            result = session.add_scan(mapped)
            waited = session.mapper.work_seconds["waiting"] - waited
            watch.scan_seconds.append(time.perf_counter() - started - waited)
            watch.waited_seconds.append(waited)
            if result is not None and result.was_tracked:
                scan_hits.append(result.hit_fraction)
        recorder.add(scan.stamp, (mapped or scan).odometry, result)
        times.append(scan.time)
    if not times:
        raise InputError(f"{recording.name}: no scan to map")
    schedule.finish(math.inf if options.until is None else times[0] + options.until)
    session.stop()
    if session.mapper.num_nodes == 0:
        raise InputError(
            f"{recording.name}: no scan made it into a map: each has fewer than "
            f"{parameters.get('min_pointcloud_size')} returns, or the map was cleared or never started"
        )
    return Drive(
        recording,
        parameters,
        session,
        recorder,
        watch,
        max(times) - min(times),
        options.keep_attempts,
        scan_hits,
    )


def _until(scans: Iterator[Scan], seconds: float | None) -> Iterator[Scan]:
    first: float | None = None
    for scan in scans:
        first = scan.time if first is None else first
        if seconds is not None and scan.time > first + seconds:
            return
        yield scan


def scans_with_progress(recording: Recording, quiet: bool) -> Iterator[Scan]:
    """The scans of a recording, with signs of life on standard error unless quiet."""
    return _progress(recording.scans(), recording, quiet)


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


def replay_to_folder(
    recording: Recording,
    parameters: Parameters,
    options: ReplayOptions,
    out: str | None = None,
    base: str | None = None,
) -> None:
    """Replays a recording, writes what came of it into the folder ``out`` and the map to the path ``base``.

    They default to oort-out/<name of the recording> and ``out``/map. Unless quiet, the report is printed. Raises
    OortError, also where the map to go on with would be overwritten.
    """
    folder = Path(out) if out else Path("oort-out") / recording.name
    map_path = base or str(folder.absolute() / "map")
    if options.resume and normalise_map_path(options.resume[0]) == normalise_map_path(map_path):
        raise InputError(
            f"{options.resume[0]}: resuming would overwrite this map; choose another place with --map or --out, or "
            "work in another folder"
        )
    if not options.quiet:
        for note in recording.notes:
            print(f"note: {note}", file=sys.stderr)
    report = write_results(replay(recording, parameters, options), folder, map_path)
    if not options.quiet:
        print(format_table(report))
        names = "trajectory.tum map.pgm map.yaml map.png histograms.png graph.g2o report.json"
        attempts = " closures.csv closures.png" if options.keep_attempts else ""
        print(f"wrote {folder}: {names}{attempts}; map: {map_path}")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="oort replay",
        description="Maps a recorded drive: a ROS 1 bag, a ROS 2 bag or MCAP, or a CARMEN log (.clf, also .gz, .bz2).",
    )
    parser.add_argument("input", help="the recording")
    parser.add_argument("--params", metavar="FILE", help="parameters (default: the packaged params.json)")
    add_recording_arguments(parser)
    parser.add_argument("--out", metavar="DIR", help="results folder (default: oort-out/<name of the input>)")
    parser.add_argument("--map", metavar="BASE", help="base path of the saved map (default: DIR/map)")
    parser.add_argument("--resume", metavar="BASE", help="a saved map to go on with")
    add_pose_argument(parser, "--pose", "the sensor's pose in it at the start [m, rad]; searched for if not given")
    parser.add_argument("--events", metavar="FILE", help="the service calls of the drive, a JSON list of t, call, args")
    parser.add_argument("--until", type=float, metavar="SECONDS", help="stop this long after the first stamp")
    parser.add_argument(
        "--closures", action="store_true", help="also write closures.csv and .png: each attempt to close a loop"
    )
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    return parser


def _run(args: argparse.Namespace) -> None:
    parameters = read_parameters(args.params)
    events = read_events(args.events) if args.events else []
    recording = recording_of(args, parameters)
    resume = None
    if args.resume:
        pose = tuple(args.pose) if args.pose else find_start(load_map(args.resume), parameters, recording)
        resume = args.resume, pose
    options = ReplayOptions(
        events=events,
        resume=resume,
        until=args.until,
        quiet=args.quiet,
        keep_attempts=args.closures,
    )
    replay_to_folder(recording, parameters, options, args.out, args.map)


def main(argv: Sequence[str] | None = None) -> int:
    """The command line tool; exit code 2 for an input or a call that cannot be used."""
    parser = _parser()
    args = parse_arguments(parser, argv)
    if args.resume is None and args.pose is not None:
        parser.error("--pose is where the robot starts on the map of --resume, which is missing")
    return run_tool("oort replay", lambda: _run(args), args.input)


if __name__ == "__main__":
    sys.exit(main())
