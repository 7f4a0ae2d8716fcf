# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort parameters``: prints the table of parameters, or writes the files that are made from it."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from oort._core import ParameterEntry, parameter_table
from oort.cli.tool import Parser, add_json_argument, print_result, run_tool
from oort.parameters.writer import documentation, write


def _parser() -> argparse.ArgumentParser:
    parser = Parser(prog="oort parameters", epilog="Example: oort parameters table", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    table = commands.add_parser("table", help="print the table as Markdown")
    writing = commands.add_parser("write", help="write params/*.json and docs/parameters.md")
    writing.add_argument("root", type=Path, help="the root of the project")
    for command in (table, writing):
        add_json_argument(command)
    return parser


def _told(entry: ParameterEntry) -> dict[str, Any]:
    names = ("path", "type", "default", "documented", "min", "max", "choices", "unit", "meaning", "status")
    return {name: getattr(entry, name) for name in names}


def _run(args: argparse.Namespace) -> None:
    if args.command == "table":
        entries = parameter_table()
        print_result(args, [_told(entry) for entry in entries], documentation(entries).removesuffix("\n"))
    else:
        written = [str(path) for path in write(args.root)]
        print_result(args, {"written": written}, "\n".join(f"wrote {path}" for path in written))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or that of run_tool()."""
    args = _parser().parse_args(argv)
    return run_tool("oort parameters", lambda: _run(args))
