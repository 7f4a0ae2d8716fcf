# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``rosrun oort oort_bag BAG TOPIC [PARAMS [MAP]]``: oort replay with the arguments of the original's tool, no core."""

import argparse
import sys
from collections.abc import Sequence

from oort._core import Parameters
from oort.cli.replay import replay_to_folder
from oort.cli.tool import add_checksum_argument, run_tool
from oort.errors import OortError
from oort.offline.replay import ReplayOptions
from oort.parameters import read_parameters
from oort.recording import Pose, open_recording
from oort.session import Session

_DOCK = "dock"
"""The namespace of docks."""


def start_in(map_path: str, *, ignore_checksum: bool = False) -> tuple[Pose, str]:
    """Where a robot probably starts in a saved map (the sensor's pose in the map frame), and what is there.

    That is the first dock, or the map's origin, where the map's own drive began. Raises MapFileError.
    """
    session = Session(Parameters())
    session.load(map_path, ignore_checksum=ignore_checksum)
    docks = session.locations.list_ids(_DOCK)
    if not docks:
        return (0.0, 0.0, 0.0), f"the map's origin, for it has no location in the namespace {_DOCK}"
    return session.locations.locate(*docks[0]), f"its location {'/'.join(docks[0])}"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="oort_bag",
        description="Maps a drive recorded in a bag; the results go to ./oort-out/<name of the bag>. "
        "'oort replay' does the same with more options.",
    )
    parser.add_argument("bag", help="the bag, with tf or odometry beside the scans")
    parser.add_argument("scan_topic", help="which LaserScan topic, for example /scan_reduced_mapping")
    parser.add_argument("params", nargs="?", help="parameters (default: the packaged params.json)")
    parser.add_argument("resume_map", nargs="?", help="a saved map to go on with, from its dock or its origin")
    add_checksum_argument(parser)
    return parser


def _run(args: argparse.Namespace) -> None:
    try:
        _replay(args)
    except OortError as error:
        if "--" not in str(error):
            raise
        raise type(error)(f"{error}. oort_bag has no such option: use 'oort replay' for it") from None


def _replay(args: argparse.Namespace) -> None:
    parameters = read_parameters(args.params)
    recording = open_recording(args.bag, scan_topic=args.scan_topic, parameters=parameters)
    resume = None
    if args.resume_map:
        pose, place = start_in(args.resume_map, ignore_checksum=args.ignore_checksum)
        print(f"note: the drive is taken to begin at {place}", file=sys.stderr)
        resume = (args.resume_map, pose)
    replay_to_folder(recording, parameters, ReplayOptions(resume=resume, ignore_checksum=args.ignore_checksum))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    args = _parser().parse_args(argv)
    return run_tool("oort_bag", lambda: _run(args), args.bag)


if __name__ == "__main__":
    sys.exit(main())
