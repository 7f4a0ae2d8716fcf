# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort replay INPUT``: maps one recorded drive and writes all that came of it into a folder."""

import argparse
import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from oort._core import Parameters, normalise_map_path
from oort.cli.recording_arguments import add_recording_arguments, recording_of
from oort.cli.tool import (
    UNCERTAIN,
    Parser,
    add_checksum_argument,
    add_json_argument,
    add_pose_argument,
    add_until_argument,
    parse_arguments,
    run_tool,
)
from oort.errors import InputError, OortError
from oort.evaluation.truth import Truth
from oort.events import read_events
from oort.export.files import make_folder
from oort.localization import find_start
from oort.offline.replay import ReplayOptions, replay
from oort.offline.results import write_results
from oort.parameters import read_parameters
from oort.recording import Recording
from oort.report.replay_report import format_table, format_troubles
from oort.report.stopwatch import without_garbage_pauses
from oort.saved_maps import open_map

_ROOM_FOR_ENDINGS = len(".map_meta_capnp.new")  # [bytes]


def replay_to_folder(
    recording: Recording,
    parameters: Parameters,
    options: ReplayOptions,
    out: str | None = None,
    base: str | None = None,
    *,
    truth: Truth | None = None,
    as_json: bool = False,
) -> Sequence[str]:
    """Replays a recording, writes what came of it into the folder ``out`` and the map to the path ``base``.

    They default to oort-out/<name of the recording> and ``out``/map. Unless quiet, the report is printed; ``as_json``
    prints report.json. With a ``truth`` the reports say how far the trajectory is off it. Returns the codes of what is
    wrong with the recording or the setup. Raises OortError, also where the map to go on with would be overwritten.
    """
    folder = Path(out) if out else Path("oort-out") / recording.name
    map_path = base or str(folder / "map")
    if options.resume and normalise_map_path(options.resume[0]) == normalise_map_path(map_path):
        raise InputError(
            f"{options.resume[0]}: resuming would overwrite this map; choose another place with --map or --out, or "
            "work in another folder"
        )
    check_name(map_path)
    make_folder(folder)
    map_folder = Path(normalise_map_path(map_path)).parent
    if not map_folder.is_dir():  # of --map: a name that is misspelt makes no folder
        raise InputError(
            f"{map_folder} is no folder, so the map cannot be saved there; make it, or choose another place"
        )
    make_folder(map_folder)
    if not options.quiet:
        for note in recording.notes:
            print(f"note: {note}", file=sys.stderr)
    with without_garbage_pauses():
        drive = replay(recording, parameters, options)
    results = write_results(drive, folder, map_path, truth)
    if not options.quiet:
        for note in results.report["notes"][len(recording.notes) :]:
            if note not in results.failed:  # told last
                print(f"note: {note}", file=sys.stderr)
        print(format_table(results.report))
        if troubles := format_troubles(results.report):
            print(troubles)
        print(f"wrote {folder}: {' '.join(name for name in results.written if name != f'the map {map_path}')}")
    if as_json:
        print(json.dumps(results.report, indent=2))
    if f"the map {map_path}" in results.written and not options.quiet:
        print(f"map: {map_path}")
    if "report.html" in results.written and not options.quiet:
        print(f"open {folder / 'report.html'}")
    if results.failed:
        raise OortError(
            f"{'; '.join(results.failed)} (written all the same: {', '.join(results.written) or 'nothing'})"
        )
    return [trouble["code"] for trouble in results.report["troubles"]]


def check_name(base: str) -> None:
    """Raises InputError for a map's path whose files cannot be named so, now rather than after the drive."""
    name = os.path.basename(normalise_map_path(base))
    if len(os.fsencode(name)) + _ROOM_FOR_ENDINGS > 255:
        raise InputError(f"the map's name {name[:40]}... is too long for a file's name; give a shorter one")


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort replay",
        description="Maps a recorded drive: a ROS 1 bag, a ROS 2 bag or MCAP, or a CARMEN log (.clf, also .gz, .bz2). "
        "Example: oort replay drive.bag --out oort-out/drive",
    )
    parser.add_argument("input", nargs="+", help="the recording; of a bag that was split, all its parts")
    parser.add_argument("--params", metavar="FILE", help="parameters (default: the packaged params.json)")
    add_recording_arguments(parser)
    parser.add_argument("--out", metavar="DIR", help="results folder (default: oort-out/<name of the input>)")
    parser.add_argument("--map", metavar="BASE", help="base path of the saved map (default: DIR/map)")
    parser.add_argument("--resume", metavar="BASE", help="a saved map to go on with")
    add_pose_argument(parser, "--pose", "the sensor's pose in it at the start [m, rad]; searched for if not given")
    add_checksum_argument(parser)
    parser.add_argument(
        "--no-odometry", action="store_true", help="ignore odometry: the scans alone say how the base moves"
    )
    parser.add_argument("--events", metavar="FILE", help="the service calls of the drive, a JSON list of t, call, args")
    parser.add_argument(
        "--truth", metavar="FILE", help="true poses of the base (TUM): the reports say how far it is off"
    )
    parser.add_argument("--relations", metavar="FILE", help="true relative poses, as for oort evaluate relations")
    add_until_argument(parser)
    parser.add_argument(
        "--closures", action="store_true", help="also write closures.csv and .png: each attempt to close a loop"
    )
    parser.add_argument(
        "--strict", action="store_true", help=f"exit with {UNCERTAIN} if where the robot was is mostly uncertain"
    )
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    add_json_argument(parser)
    return parser


def _run(args: argparse.Namespace) -> int:
    parameters = read_parameters(args.params)
    if args.no_odometry:
        parameters.set("use_odometry", False)
    events = read_events(args.events) if args.events else []
    truth = Truth(args.truth, args.relations)
    truth.check()
    recording = recording_of(args, parameters)
    resume = None
    if args.resume:
        if args.pose:
            pose = tuple(args.pose)
        else:
            pose = find_start(open_map(args.resume, ignore_checksum=args.ignore_checksum), parameters, recording)
        resume = args.resume, pose
    options = ReplayOptions(
        events=events,
        resume=resume,
        ignore_checksum=args.ignore_checksum,
        until=args.until,
        quiet=args.quiet or args.json,
        keep_attempts=args.closures,
    )
    troubles = replay_to_folder(recording, parameters, options, args.out, args.map, truth=truth, as_json=args.json)
    return UNCERTAIN if args.strict and "uncertain" in troubles else 0


def main(argv: Sequence[str] | None = None) -> int:
    """The command line tool; exit code 2 for an input or a call that cannot be used."""
    parser = _parser()
    args = parse_arguments(parser, argv)
    if args.resume is None and args.pose is not None:
        parser.error("--pose is where the robot starts on the map of --resume, which is missing")
    return run_tool("oort replay", lambda: _run(args), args.input[0])
