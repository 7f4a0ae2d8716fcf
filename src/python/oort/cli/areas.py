# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort areas MAP``: areas and lines of a saved map where the robot shall not go."""

import argparse
from collections.abc import Sequence

from oort.areas import FEWEST, Area, areas_of_map, make_area
from oort.cli.tool import Parser, add_checksum_argument, add_json_argument, parse_arguments, print_result, run_tool
from oort.errors import InputError
from oort.parameters import read_parameters
from oort.saved_maps import open_map
from oort.session import Session


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort areas",
        description="Lists, adds and removes areas and lines of a saved map where the robot shall not go; they move "
        "with the map. Example: oort areas maps/home --add no_go_area carpet --points 1 1 2.5 1 2.5 2 1 2",
    )
    parser.add_argument("map", metavar="MAP", help="the path of the map")
    parser.add_argument("--add", nargs=2, metavar=("KIND", "NAME"), help=f"KIND is {' or '.join(FEWEST)}")
    parser.add_argument(
        "--points", nargs="+", type=float, default=[], metavar="X", help="of the one to add: X Y X Y ..., metres"
    )
    parser.add_argument("--remove", nargs=2, metavar=("KIND", "NAME"), help="forget one")
    add_json_argument(parser)
    add_checksum_argument(parser)
    return parser


def _change(args: argparse.Namespace) -> None:
    session = Session(read_parameters())
    session.load(args.map, ignore_checksum=args.ignore_checksum)
    if args.remove:
        kind, name = args.remove
        if not session.clear_locations(f"{kind}/{name}"):
            raise InputError(f"{args.map}: there is no {kind} {name!r}")
    if args.add:
        if len(args.points) % 2:
            raise InputError(f"--points: {len(args.points)} numbers are no pairs of x and y")
        kind, name = args.add
        session.create_area(make_area(kind, name, zip(args.points[::2], args.points[1::2], strict=True)))


def _line(area: Area) -> str:
    points = ", ".join(f"{x:z.2f} {y:z.2f}" for x, y in area.points)
    return f"{area.kind}  {area.name}  ({points})"


def _run(args: argparse.Namespace) -> None:
    if args.add or args.remove:
        _change(args)
    areas = areas_of_map(open_map(args.map, ignore_checksum=args.ignore_checksum))
    told = [{"kind": area.kind, "name": area.name, "points": area.points} for area in areas]
    print_result(args, told, "\n".join(map(_line, areas)) or f"{args.map}: no areas")


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    args = parse_arguments(_parser(), argv)
    return run_tool("oort areas", lambda: _run(args), args.map)
