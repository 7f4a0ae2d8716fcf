# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort info PATH``: what a saved map or a recording is."""

import argparse
from collections.abc import Sequence

from oort.cli.recording_arguments import add_recording_arguments, recording_of
from oort.cli.tool import Parser, add_checksum_argument, add_json_argument, parse_arguments, print_result, run_tool
from oort.offline.info import format_info, is_saved_map, map_info, recording_info
from oort.parameters import read_parameters


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort info",
        description="Says what a saved map holds (size, nodes, closures, places, areas, earlier versions) or what a "
        "recording is (scans, rate, laser, odometry). Example: oort info maps/home --json",
    )
    parser.add_argument("input", nargs="+", metavar="PATH", help="a saved map, or a recording as for oort replay")
    add_recording_arguments(parser)
    add_checksum_argument(parser)
    add_json_argument(parser)
    return parser


def _run(args: argparse.Namespace) -> None:
    parameters = read_parameters()
    if len(args.input) == 1 and is_saved_map(args.input[0]):
        info = map_info(args.input[0], parameters, ignore_checksum=args.ignore_checksum)
    else:
        info = recording_info(recording_of(args, parameters))
    print_result(args, info, format_info(info))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    args = parse_arguments(_parser(), argv)
    return run_tool("oort info", lambda: _run(args), args.input[0])
