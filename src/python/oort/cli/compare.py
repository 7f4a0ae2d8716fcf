# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort compare A B``: lays two replays side by side and over each other, in one page."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from oort.cli.tool import Parser, add_json_argument, print_result, run_tool
from oort.offline.compare import compare

_PAGE = "compare.html"


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort compare",
        description="Lays two replays side by side and over each other: maps, figures, parameters that differ, and how "
        "far apart they have the robot. Example: oort compare oort-out/before oort-out/after",
    )
    parser.add_argument("a", metavar="A", help="the folder of a replay, or its report.html")
    parser.add_argument("b", metavar="B", help="another one")
    parser.add_argument("--out", metavar="FILE", default=_PAGE, help=f"the page (default: {_PAGE})")
    add_json_argument(parser)
    return parser


def _run(args: argparse.Namespace) -> None:
    out = Path(args.out)
    if out.is_dir():
        out /= _PAGE
    elif out.suffix not in (".html", ".htm"):  # a browser takes it for text
        out = out.with_name(f"{out.name}.html")
    comparison = compare(args.a, args.b, str(out))
    print_result(args, comparison, f"open {out}")


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    args = _parser().parse_args(argv)
    return run_tool("oort compare", lambda: _run(args))
