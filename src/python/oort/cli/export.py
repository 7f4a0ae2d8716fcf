# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort export MAP FORMAT OUT``: writes a saved map in the formats of other programs."""

import argparse
from collections.abc import Sequence

from oort.cli.tool import Parser, add_checksum_argument, add_json_argument, print_result, run_tool
from oort.offline.export import FORMATS, export
from oort.parameters import read_parameters
from oort.saved_maps import open_map


def _parser() -> argparse.ArgumentParser:
    formats = "\n".join(f"  {name:<11} {what}" for name, what in FORMATS.items())
    parser = Parser(
        prog="oort export",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Writes a saved map in the format of another program. Example: oort export maps/home dxf home.dxf",
        epilog=f"formats:\n{formats}",
    )
    parser.add_argument("map", metavar="MAP", help="the map's path, with or without .map_capnp")
    parser.add_argument("format", metavar="FORMAT", choices=list(FORMATS), help="one of the formats below")
    parser.add_argument("out", metavar="OUT", help="the file to write")
    parser.add_argument("--params", metavar="FILE", help="parameters of drawing (default: the packaged params.json)")
    add_checksum_argument(parser)
    add_json_argument(parser)
    return parser


def _run(args: argparse.Namespace) -> None:
    map_ = open_map(args.map, ignore_checksum=args.ignore_checksum)
    written = export(map_, read_parameters(args.params), args.format, args.out)
    print_result(args, {"written": written}, f"wrote {' '.join(written)}")


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    args = _parser().parse_args(argv)
    return run_tool("oort export", lambda: _run(args), args.map)
