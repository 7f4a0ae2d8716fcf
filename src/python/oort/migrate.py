# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort migrate IN OUT``: writes a saved map in the newest format, or as the original Oort did."""

import argparse
import sys
from collections.abc import Sequence

from oort._core import FORMAT_VERSION, load_map, normalise_map_path, read_map_format, save_map
from oort.errors import InputError
from oort.tool import run_tool


def migrate(source: str, target: str, *, to_original: bool = False) -> str:
    """Writes a map in another format, with the same content; returns what to print.

    Raises InputError if both are the same map, and MapFileError.
    """
    if normalise_map_path(source) == normalise_map_path(target):
        raise InputError(f"{target}: the new map would replace the old one; choose another place")
    old = read_map_format(source)
    map_ = load_map(source)
    save_map(target, map_, as_original=to_original)
    writer = f", written by {old.written_by}" if old.written_by else ""
    new = 0 if to_original else FORMAT_VERSION
    return f"{source}: format {old.version}{writer}, {len(map_)} nodes\n{target}: format {new}"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="oort migrate", description="Writes a saved map of any format that this Oort reads in the newest one."
    )
    parser.add_argument("source", metavar="IN", help="the path of the map")
    parser.add_argument("target", metavar="OUT", help="where the new one goes")
    parser.add_argument("--original", action="store_true", help="write the format of the original Oort instead")
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    arguments = _parser().parse_args(argv)
    return run_tool(
        "oort migrate",
        lambda: print(migrate(arguments.source, arguments.target, to_original=arguments.original)),
        arguments.source,
    )


if __name__ == "__main__":
    sys.exit(main())
