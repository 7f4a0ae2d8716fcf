# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort merge A B OUT``: joins two saved maps of the same home into one."""

import argparse
from collections.abc import Sequence

from oort.cli.tool import (
    Parser,
    add_checksum_argument,
    add_json_argument,
    add_pose_argument,
    parse_arguments,
    print_steps,
    run_tool,
)
from oort.offline.merge import merge
from oort.parameters import read_parameters


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort merge",
        epilog="Example: oort merge maps/up maps/down maps/home",
        description="Joins two saved maps of the same home into one, in the frame of the first. Neither is changed. "
        "OUT.png shows the new map, the second one's way and the closures that tie it to the first.",
    )
    parser.add_argument("first", metavar="A", help="the path of the first map, whose frame and places are kept")
    parser.add_argument("second", metavar="B", help="the path of the second map")
    parser.add_argument("target", metavar="OUT", help="where the new map goes")
    add_pose_argument(
        parser, "--at", "about where the second map's origin lies on the first [m, rad]; found if not given"
    )
    parser.add_argument("--params", metavar="FILE", help="parameters (default: the packaged params.json)")
    add_checksum_argument(parser)
    add_json_argument(parser)
    return parser


def _run(args: argparse.Namespace) -> None:
    at = (args.at[0], args.at[1], args.at[2]) if args.at else None
    parameters = read_parameters(args.params)
    checksum = args.ignore_checksum
    print_steps(args, merge(args.first, args.second, args.target, parameters, at, ignore_checksum=checksum))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or that of run_tool()."""
    args = parse_arguments(_parser(), argv)
    return run_tool("oort merge", lambda: _run(args), args.first)
