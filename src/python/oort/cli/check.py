# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort check INPUT``: says what is wrong with a recording or a robot's setup, without keeping a map."""

import argparse
from collections.abc import Sequence

from oort.cli.recording_arguments import add_recording_arguments, recording_of
from oort.cli.tool import (
    UNCERTAIN,
    Parser,
    add_json_argument,
    add_until_argument,
    parse_arguments,
    print_result,
    run_tool,
)
from oort.offline.replay import ReplayOptions, replay
from oort.parameters import read_parameters


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort check",
        epilog="Example: oort check drive.bag --json",
        description="Maps a recorded drive, keeps nothing, and says what is wrong with the recording or the setup.",
    )
    parser.add_argument("input", nargs="+", help="the recording, as for oort replay")
    parser.add_argument("--params", metavar="FILE", help="parameters (default: the packaged params.json)")
    add_recording_arguments(parser)
    add_until_argument(parser)
    parser.add_argument(
        "--strict", action="store_true", help=f"exit with {UNCERTAIN} if where the robot was is mostly uncertain"
    )
    add_json_argument(parser)
    return parser


def _run(args: argparse.Namespace) -> int:
    parameters = read_parameters(args.params)
    recording = recording_of(args, parameters)
    drive = replay(recording, parameters, ReplayOptions(until=args.until, quiet=args.json))
    troubles = drive.troubles
    told = {"input": recording.name, "notes": recording.notes, "troubles": [each.to_dict() for each in troubles]}
    lines = [*(f"note: {note}" for note in recording.notes), *(f"- {trouble}" for trouble in troubles)]
    if not troubles:
        lines.append("nothing is wrong, as far as the drive shows")
    print_result(args, told, "\n".join(lines))
    return UNCERTAIN if args.strict and any(trouble.code == "uncertain" for trouble in troubles) else 0


def main(argv: Sequence[str] | None = None) -> int:
    """The command line tool; exit code 2 for an input or a call that cannot be used."""
    args = parse_arguments(_parser(), argv)
    return run_tool("oort check", lambda: _run(args), args.input[0])
