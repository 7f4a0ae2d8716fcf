# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort history MAP``: lists the earlier versions of a saved map, or goes back to one."""

import argparse
from collections.abc import Sequence
from dataclasses import asdict

from oort.cli.tool import Parser, add_json_argument, print_result, run_tool
from oort.errors import InputError
from oort.history import describe, restore, versions
from oort.offline.info import is_saved_map


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort history",
        epilog="Example: oort history maps/home --restore 1",
        description="Lists the earlier versions of a saved map: what it was before each of the last sessions that were "
        "saved over it.",
    )
    parser.add_argument("map", metavar="MAP", help="the path of the map")
    parser.add_argument(
        "--restore", type=int, metavar="N", help="make version N the map again; what it is now becomes version 1"
    )
    add_json_argument(parser)
    return parser


def _run(arguments: argparse.Namespace) -> None:
    if not is_saved_map(arguments.map) and not versions(arguments.map):
        raise InputError(f"{arguments.map}: there is no map, nor an earlier version of one; check the path")
    if arguments.restore is not None:
        restore(arguments.map, arguments.restore)
        told = f"{arguments.map}: is version {arguments.restore} again; what it was is version 1 now"
    else:
        told = "\n".join(map(describe, versions(arguments.map))) or f"{arguments.map}: no earlier versions"
    print_result(arguments, [asdict(version) for version in versions(arguments.map)], told)


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    arguments = _parser().parse_args(argv)
    return run_tool("oort history", lambda: _run(arguments), arguments.map)
