# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort render MAP PREFIX [PARAMS]`` or ``rosrun oort oort_conv``: draws a saved map as pictures for map_server."""

import argparse
from collections.abc import Sequence

from oort.cli.tool import Parser, add_checksum_argument, add_json_argument, print_steps, run_tool
from oort.offline.render import render
from oort.parameters import read_parameters


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort render",
        epilog="Example: oort render maps/home pictures/home",
        description="Draws a saved map: PREFIX_map.png, and PREFIX_map_cleaned.png without speckle noise, each with "
        "the .yaml that map_server reads. One pixel is one cell: 254 free, 0 occupied, 205 unknown.",
    )
    parser.add_argument("map", help="the map's path, with or without .map_capnp")
    parser.add_argument("prefix", metavar="prefix", help="where the pictures go, for example maps/home")
    parser.add_argument("params", nargs="?", help="parameters (default: the packaged params.json)")
    add_checksum_argument(parser)
    add_json_argument(parser)
    return parser


def _run(args: argparse.Namespace) -> None:
    parameters = read_parameters(args.params)
    print_steps(args, render(args.map, args.prefix, parameters, ignore_checksum=args.ignore_checksum))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    args = _parser().parse_args(argv)
    return run_tool("oort render", lambda: _run(args), args.map)
