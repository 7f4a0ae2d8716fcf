# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort completion SHELL``: prints what makes a shell complete the words and options of ``oort``."""

import argparse
import importlib
from collections.abc import Mapping, Sequence

from oort.cli.tool import Parser, add_json_argument, print_result, run_tool
from oort.errors import OortError

_SHELLS = ("bash", "zsh", "tcsh")


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="oort completion",
        description="Prints a script for a shell, which then completes the tools and their options. "
        'Example: eval "$(oort completion bash)"',
    )
    parser.add_argument("shell", choices=_SHELLS, help="whose script")
    add_json_argument(parser)
    return parser


def whole_parser(tools: Mapping[str, str]) -> argparse.ArgumentParser:
    """One parser of all tools."""
    parser = argparse.ArgumentParser(prog="oort")
    words = parser.add_subparsers()
    for name, what in tools.items():
        own = importlib.import_module(f"oort.cli.{name}")._parser()
        words.add_parser(name, parents=[own], add_help=False, help=what)
    return parser


def _run(args: argparse.Namespace) -> None:
    from oort.cli.main import TOOLS

    try:
        import shtab
    except ImportError:
        raise OortError("completion needs the package shtab: pip install 'oort[completion]'") from None
    script = shtab.complete(whole_parser(TOOLS), args.shell)
    print_result(args, {"shell": args.shell, "script": script}, script)


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status: 0, or 2 for an error, which is printed."""
    args = _parser().parse_args(argv)
    return run_tool("oort completion", lambda: _run(args))
