# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort rooms MAP``: the rooms of a saved map with their areas, and their names."""

import argparse
from collections.abc import Sequence
from typing import Any

from oort.cli.tool import Parser, add_checksum_argument, add_json_argument, print_result, run_tool
from oort.errors import InputError
from oort.export.named_rooms import ROOMS, NamedRoom
from oort.offline.export import rooms_of
from oort.parameters import read_parameters
from oort.saved_maps import open_map
from oort.session import Session


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort rooms",
        description="Lists the rooms of a saved map with their areas, the largest first, and names them. A name is "
        "kept in the map as a place of the namespace rooms. Example: oort rooms maps/home --name 2 kitchen",
    )
    parser.add_argument("map", metavar="MAP", help="the path of the map")
    parser.add_argument(
        "--name",
        nargs=2,
        action="append",
        default=[],
        metavar=("N", "NAME"),
        help="name room number N; may be repeated",
    )
    parser.add_argument("--params", metavar="FILE", help="parameters of drawing (default: the packaged params.json)")
    add_json_argument(parser)
    add_checksum_argument(parser)
    return parser


def _name(args: argparse.Namespace, rooms: Sequence[NamedRoom]) -> None:
    session = Session(read_parameters(args.params))
    session.load(args.map, ignore_checksum=args.ignore_checksum)
    for number, name in args.name:
        chosen = next((named for named in rooms if str(named.number) == number), None)
        if chosen is None:
            raise InputError(f"{args.map}: there is no room {number}; there are 1 to {len(rooms)}")
        for old in filter(None, chosen.name.split(", ")):
            session.delete_location(ROOMS, old)
        session.create_points([ROOMS], [chosen.room.centre], [name])


def _told(named: NamedRoom) -> dict[str, Any]:
    room = named.room
    return {
        "number": named.number,
        "name": named.name,
        "area": room.area,
        "outline": room.outline.tolist(),
        "open_sides": room.open_sides,
    }


def _line(named: NamedRoom) -> str:
    size = named.room.outline.max(axis=0) - named.room.outline.min(axis=0)
    sides = named.room.open_sides
    doubt = "not a rectangle" if sides is None else f"no wall seen on {sides} of 4 sides" if sides else ""
    x, y = named.room.centre
    return (
        f"{named.number:>3}  {named.name or '-':<16} {named.room.area:6.1f} m²  {size[0]:.1f} x {size[1]:.1f} m  "
        f"at {x:z.2f}, {y:z.2f}  {doubt}"
    ).rstrip()


def _run(args: argparse.Namespace) -> None:
    parameters = read_parameters(args.params)
    rooms = rooms_of(open_map(args.map, ignore_checksum=args.ignore_checksum), parameters)
    if args.name:
        _name(args, rooms)
        rooms = rooms_of(open_map(args.map, ignore_checksum=args.ignore_checksum), parameters)
    total = f"{len(rooms)} rooms, {sum(named.room.area for named in rooms):.1f} m²"
    print_result(args, [_told(named) for named in rooms], "\n".join([*map(_line, rooms), total]))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    args = _parser().parse_args(argv)
    return run_tool("oort rooms", lambda: _run(args), args.map)
