# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort migrate IN OUT``: writes a saved map in the newest format, or as the original Oort did."""

import argparse
from collections.abc import Sequence

from oort.cli.tool import add_checksum_argument, run_tool
from oort.offline.migrate import migrate


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="oort migrate",
        epilog="Example: oort migrate maps/old maps/new",
        description="Writes a saved map of any format that this Oort reads in the newest one.",
    )
    parser.add_argument("source", metavar="IN", help="the path of the map")
    parser.add_argument("target", metavar="OUT", help="where the new one goes")
    parser.add_argument("--original", action="store_true", help="write the format of the original Oort instead")
    add_checksum_argument(parser)
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    arguments = _parser().parse_args(argv)
    return run_tool(
        "oort migrate",
        lambda: print(
            migrate(
                arguments.source,
                arguments.target,
                to_original=arguments.original,
                ignore_checksum=arguments.ignore_checksum,
            )
        ),
        arguments.source,
    )
