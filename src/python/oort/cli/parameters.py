# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort parameters``: prints the table of parameters, or writes the files that are made from it."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from oort._core import parameter_table
from oort.parameters.writer import documentation, write


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="oort parameters", epilog="Example: oort parameters table", description=__doc__
    )
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("table", help="print the table as Markdown")
    writing = commands.add_parser("write", help="write params/*.json and docs/parameters.md")
    writing.add_argument("root", type=Path, help="the root of the project")
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command line; returns the exit status."""
    options = _parser().parse_args(arguments)
    if options.command == "table":
        sys.stdout.write(documentation(parameter_table()))
    else:
        write(options.root)
    return 0
