# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort render MAP PREFIX [PARAMS]`` or ``rosrun oort oort_conv``: draws a saved map as pictures for map_server."""

import argparse
import sys
from collections.abc import Sequence

from oort._core import load_map, render_map
from oort.errors import InputError
from oort.export import write_map_server
from oort.parameters import read_parameters
from oort.tool import run_tool


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="oort render",
        description="Draws a saved map: PREFIX_map.png, and PREFIX_map_cleaned.png without speckle noise, each with "
        "the .yaml that map_server reads. One pixel is one cell: 254 free, 0 occupied, 205 unknown.",
    )
    parser.add_argument("map", help="the map's path, with or without .map_capnp")
    parser.add_argument("prefix", metavar="prefix", help="where the pictures go, for example maps/home")
    parser.add_argument("params", nargs="?", help="parameters (default: the packaged params.json)")
    return parser


def _run(args: argparse.Namespace) -> None:
    parameters = read_parameters(args.params)
    for grid, name in zip(render_map(load_map(args.map), parameters), ("map", "map_cleaned"), strict=True):
        if not grid.cells.size:
            raise InputError(f"{args.map}: there is nothing to draw, for no scan of this map has a return")
        base = f"{args.prefix}_{name}"
        write_map_server(base, grid.cells, grid.resolution, (*grid.origin, 0.0), image_format="png")
        print(f"{base}.png {base}.yaml")


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    args = _parser().parse_args(argv)
    return run_tool("oort render", lambda: _run(args), args.map)


if __name__ == "__main__":
    sys.exit(main())
