# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort migrate IN OUT``: writes a saved map in the newest format, or as the original Oort did."""

import argparse
from collections.abc import Sequence

from oort.cli.tool import Parser, add_checksum_argument, add_json_argument, print_result, run_tool
from oort.offline.migrate import migrate


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort migrate",
        epilog="Example: oort migrate maps/old maps/new",
        description="Writes a saved map of any format that this Oort reads in the newest one.",
    )
    parser.add_argument("source", metavar="IN", help="the path of the map")
    parser.add_argument("target", metavar="OUT", help="where the new one goes")
    parser.add_argument("--original", action="store_true", help="write the format of the original Oort instead")
    add_checksum_argument(parser)
    add_json_argument(parser)
    return parser


def _run(args: argparse.Namespace) -> None:
    maps = migrate(args.source, args.target, to_original=args.original, ignore_checksum=args.ignore_checksum)
    source, target = maps["source"], maps["target"]
    writer = f", written by {source['written_by']}" if source["written_by"] else ""
    lines = [
        f"{source['path']}: format {source['format']}{writer}, {source['nodes']} nodes",
        f"{target['path']}: format {target['format']}",
    ]
    print_result(args, maps, "\n".join(lines))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    args = _parser().parse_args(argv)
    return run_tool("oort migrate", lambda: _run(args), args.source)
