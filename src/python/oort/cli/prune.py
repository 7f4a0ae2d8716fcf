# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort prune IN OUT``: writes a saved map with only the views that it needs."""

import argparse
from collections.abc import Sequence

from oort.cli.tool import Parser, add_checksum_argument, add_json_argument, number, print_result, run_tool
from oort.offline.prune import prune
from oort.parameters import read_parameters


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort prune",
        epilog="Example: oort prune maps/home maps/pruned",
        description="Writes a saved map that grew over many sessions with only the views that it needs. Places, docks "
        "and poses stay; what newer sessions contradict is taken out.",
    )
    parser.add_argument("source", metavar="IN", help="the path of the map")
    parser.add_argument("target", metavar="OUT", help="where the new one goes")
    parser.add_argument(
        "--views",
        type=number,
        metavar="N",
        help="of a piece of surface from one side (default: keep_views of params.json)",
    )
    add_checksum_argument(parser)
    add_json_argument(parser)
    return parser


def _run(args: argparse.Namespace) -> None:
    views = args.views or int(read_parameters().get("keep_views"))
    maps = prune(args.source, args.target, views, ignore_checksum=args.ignore_checksum)
    lines = ["{path}: {nodes} nodes, {closures} closures".format(**figures) for figures in maps.values()]
    print_result(args, maps, "\n".join(lines))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    args = _parser().parse_args(argv)
    return run_tool("oort prune", lambda: _run(args), args.source)
