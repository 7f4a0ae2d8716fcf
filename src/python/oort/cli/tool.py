# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the command line tools have in common: arguments that several take, and how each ends."""

import argparse
import io
import json
import math
import os
import re
import signal
import sys
from collections.abc import Callable, Generator, Sequence
from typing import Any

from oort.errors import OortError
from oort.export.files import decimal
from oort.interrupts import take_interrupts

UNCERTAIN = 3
"""The exit status of ``--strict`` where most of a drive is uncertain."""

FAULT = 1
"""The exit status after a fault of Oort's own."""

_LONGEST = 2000  # characters of a message
_DEBUG = "OORT_DEBUG"
"""The environment's variable that lets faults of Oort's own through with their traceback."""
_PLAIN = re.compile(r"-\d+|-\d*\.\d+")
"""The negative numbers that argparse does not take for options."""


def run_tool(name: str, run: Callable[[], int | None], reading: str = "") -> int:
    """Runs a tool; the exit status is what it returns, 0 for None, 2 for an error, 130 for Ctrl-C, 1 for a fault of
    Oort's own; none of them is told with a traceback.

    ``reading`` is the file that an error of the operating system is about if it names none.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # of names that the terminal cannot show
    try:
        take_interrupts()
        status = run()
        sys.stdout.flush()
    except BrokenPipeError:  # who reads has seen enough, as with head
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 128 + signal.SIGPIPE
    except (OortError, OSError, MemoryError) as error:
        print(f"{name}: {_told(error, reading)}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(f"{name}: interrupted", file=sys.stderr)
        return 128 + signal.SIGINT
    except Exception as error:
        if os.environ.get(_DEBUG):
            raise
        why = f"{type(error).__name__}: {_told(error, reading)}"
        print(
            f"{name}: this is a fault of Oort's ({why}); please report it, with what {_DEBUG}=1 shows", file=sys.stderr
        )
        return FAULT
    return status or 0


def _told(error: Exception, reading: str) -> str:
    if isinstance(error, MemoryError):
        return f"{reading}: it takes more memory than there is"
    text = f"{error.filename or reading}: {error.strerror}" if isinstance(error, OSError) else str(error)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST // 2]} [...] {text[-_LONGEST // 2 :]}"


Arguments = argparse.ArgumentParser | argparse._ArgumentGroup
"""what options are added to"""


def add_json_argument(parser: Arguments) -> None:
    """The option ``--json``, which every tool has; print_result() heeds it."""
    parser.add_argument("--json", action="store_true", help="print JSON and nothing else but errors")


def print_result(args: argparse.Namespace, result: Any, text: str) -> None:
    """What a tool has to tell: as JSON if ``--json`` was given, else the text."""
    print(json.dumps(_finite(result), indent=2, allow_nan=False) if args.json else text, flush=True)


def print_steps(args: argparse.Namespace, steps: Generator[str, None, Any]) -> None:
    """What a tool tells on its way, line by line as it comes; with ``--json`` only what it returns at the end."""
    while True:
        try:
            line = next(steps)
        except StopIteration as end:
            if args.json:
                print_result(args, end.value, "")
            return
        if not args.json:
            print(line, flush=True)


def _finite(value: Any) -> Any:
    """JSON knows no infinities and no NaN: null stands for them."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(each) for key, each in value.items()}
    return [_finite(each) for each in value] if isinstance(value, list | tuple) else value


def add_pose_argument(parser: Arguments, name: str, meaning: str) -> None:
    """An option that takes a pose, x, y [m] and theta [rad]; parse_arguments() must read it."""
    parser.add_argument(name, type=float, nargs=3, metavar=("X", "Y", "THETA"), help=meaning)


def add_checksum_argument(parser: argparse.ArgumentParser) -> None:
    """The option ``--ignore-checksum`` of the tools that read maps."""
    parser.add_argument(
        "--ignore-checksum", action="store_true", help="read a map though its checksums are lost or do not fit"
    )


def add_worker_arguments(parser: argparse.ArgumentParser) -> None:
    """Where the tools for many recordings do their work."""
    parser.add_argument(
        "--jobs", metavar="N", type=int, default=os.cpu_count() or 1, help="so many at a time (default: cores)"
    )
    parser.add_argument("--cluster", metavar="ADDRESS", help="a Dask cluster instead, such as tcp://scheduler:8786")


def parse_arguments(parser: argparse.ArgumentParser, argv: Sequence[str] | None) -> argparse.Namespace:
    """Parses arguments (default: those of the process), among them numbers such as -1e-3.

    argparse takes negative numbers for options unless they are plain decimals, so they are made plain.
    """
    return parser.parse_args([_plain(argument) for argument in (sys.argv[1:] if argv is None else argv)])


def _plain(argument: str) -> str:
    if not argument.startswith("-") or _PLAIN.fullmatch(argument):
        return argument
    try:
        number = float(argument)
    except ValueError:
        return argument
    return decimal(number) if math.isfinite(number) else argument
