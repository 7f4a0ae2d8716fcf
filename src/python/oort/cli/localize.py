# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort localize MAP RECORDING``: follows a recorded drive on a saved map, which stays as it is."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from oort.cli.recording_arguments import add_recording_arguments, recording_of
from oort.cli.tool import (
    UNCERTAIN,
    Parser,
    add_checksum_argument,
    add_json_argument,
    add_pose_argument,
    parse_arguments,
    print_result,
    run_tool,
)
from oort.export.files import make_folder
from oort.image_maps import open_reference_map
from oort.localization import STARTS, start_pose
from oort.offline.follow import follow
from oort.offline.localization_results import format_localization, write_localization
from oort.offline.progress import scans_with_progress
from oort.parameters import read_parameters
from oort.recording import Pose


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort localize",
        description="Follows a recorded drive on a saved map, without changing the map. "
        "Example: oort localize maps/home drive.bag",
    )
    parser.add_argument("map", help="base path of the saved map, or the .yaml of one of map_server")
    parser.add_argument("input", nargs="+", help="the recording, as for oort replay")
    parser.add_argument("--start", choices=STARTS, default=STARTS[0], help="how to begin (default: global, a search)")
    add_pose_argument(parser, "--pose", "the sensor's pose for --start pose [m, rad]")
    parser.add_argument("--params", metavar="FILE", help="parameters (default: the packaged params.json)")
    add_recording_arguments(parser)
    parser.add_argument("--out", metavar="DIR", help="results folder (default: oort-out/<name of the input>-localized)")
    add_checksum_argument(parser)
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    add_json_argument(parser)
    return parser


def _run(args: argparse.Namespace) -> int:
    parameters = read_parameters(args.params)
    map_ = open_reference_map(args.map, ignore_checksum=args.ignore_checksum)
    recording = recording_of(args, parameters)
    start: Pose | None = None
    if args.start == "pose":
        start = tuple(args.pose)
    elif args.start != "global":
        start = start_pose(map_, parameters, args.start)
    folder = Path(args.out) if args.out else Path("oort-out") / f"{recording.name}-localized"
    make_folder(folder)
    drive = follow(recording, scans_with_progress(recording, args.quiet or args.json), map_, parameters, start)
    report = write_localization(drive, map_, args.map, parameters, folder)
    found = bool(report["scans_with_pose"])
    if not args.quiet and not args.json:
        for note in recording.notes:
            print(f"note: {note}", file=sys.stderr)
    if args.json or not args.quiet:
        told = f"{format_localization(report)}\nwrote {folder}: trajectory.tum map.png report.json"
        print_result(args, report, told)
    if not found:
        print(
            f"oort localize: {recording.name}: the robot was not found on {args.map}; if the map is of this place, say "
            "where the drive begins with --start pose --pose X Y THETA",
            file=sys.stderr,
        )
    return 0 if found else UNCERTAIN


def main(argv: Sequence[str] | None = None) -> int:
    """The command line tool; exit code 2 for an input or a call that cannot be used."""
    parser = _parser()
    args = parse_arguments(parser, argv)
    if (args.start == "pose") != (args.pose is not None):
        parser.error("--start pose and --pose go together")
    return run_tool("oort localize", lambda: _run(args), args.input[0])
