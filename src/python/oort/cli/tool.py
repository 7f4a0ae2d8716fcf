# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the command line tools have in common: arguments that several take, and how each ends."""

import argparse
import errno
import io
import json
import math
import os
import re
import signal
import sys
import warnings
from collections.abc import Callable, Generator, Sequence
from typing import Any, NoReturn, TextIO

from oort.errors import OortError
from oort.export.files import decimal
from oort.interrupts import take_interrupts

UNCERTAIN = 3
"""The exit status of ``--strict`` where most of a drive is uncertain, and of a drive that was never found on a map."""

FAULT = 1
"""The exit status after a fault of Oort's own."""

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
_LONGEST = 2000  # characters of a message
_DEBUG = "OORT_DEBUG"
"""The environment's variable that lets faults of Oort's own through with their traceback."""
_PLAIN = re.compile(r"-\d+|-\d*\.\d+")
"""The negative numbers that argparse does not take for options."""


_ADVICE: dict[type[OSError], str] = {
    FileExistsError: "; it is no folder, so choose another path",
    NotADirectoryError: "; choose another path",
    FileNotFoundError: "; check the path",
    PermissionError: "; check who may read and write there",
}
"""what to do about an error of the operating system"""


def run_tool(name: str, run: Callable[[], int | None], reading: str = "") -> int:
    """Runs a tool; the exit status is what it returns, 0 for None, 2 for an error, 130 for Ctrl-C, 1 for a fault of
    Oort's own; none of them is told with a traceback.

    ``reading`` is the file that an error of the operating system is about if it names none.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # of names that the terminal cannot show
    usual, warnings.formatwarning = warnings.formatwarning, _note
    try:
        take_interrupts()
        return _run_told(name, run, reading)
    except BrokenPipeError:  # who reads has seen enough, as with head
        _discard(sys.stdout, sys.stderr)
        return 128 + signal.SIGPIPE
    except KeyboardInterrupt:
        print(f"{name}: interrupted", file=sys.stderr)
        return 128 + signal.SIGINT
    finally:
        warnings.formatwarning = usual


def _run_told(name: str, run: Callable[[], int | None], reading: str) -> int:
    """Runs a tool and tells its errors, all but that it was interrupted and that nobody reads."""
    try:
        status = run()
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except (OortError, OSError, MemoryError) as error:
        if isinstance(error, OSError) and not error.filename and error.errno in _FULL:  # files are written with names
            _discard(sys.stdout)
            reading = "standard output"
        # Errors begin with the method that was called, which may be what the tool is called.
        print(f"{name}: {_told(error, reading).removeprefix(f'{name.split()[-1]}: ')}", file=sys.stderr)
        return 2
    except Exception as error:
        if os.environ.get(_DEBUG):
            raise
        why = f"{type(error).__name__}: {_told(error, reading)}"
        print(
            f"{name}: this is a fault of Oort's ({why}); please report it, with what {_DEBUG}=1 shows", file=sys.stderr
        )
        return FAULT
    return status or 0


def _discard(*streams: TextIO) -> None:
    """Lets go what was printed to streams, so that Python does not complain of it at the end."""
    for stream in streams:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _note(message: Warning | str, category: type[Warning], filename: str, lineno: int, line: str | None = None) -> str:
    """A warning as people read it: without the line of source that it came from."""
    return f"note: {message}\n"


def _told(error: Exception, reading: str) -> str:
    if isinstance(error, MemoryError):
        return f"{reading}: it takes more memory than there is"
    text = str(error)
    if isinstance(error, OSError):
        advice = next((told for kind, told in _ADVICE.items() if isinstance(error, kind)), "")
        text = f"{error.filename or reading}: {error.strerror}{advice}"
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST // 2]} [...] {text[-_LONGEST // 2 :]}"


class Parser(argparse.ArgumentParser):
    """Tells what is wrong with a call in one line, as every other error is told; --help has the rest."""

    def error(self, message: str) -> NoReturn:
        """Ends the program."""
        self.exit(2, f"{self.prog}: {message}; {self.prog} --help tells how it is called\n")


def add_until_argument(parser: argparse.ArgumentParser) -> None:
    """The option that ends a drive early."""
    parser.add_argument("--until", type=seconds, metavar="SECONDS", help="stop this long after the first stamp")


def seconds(text: str) -> float:
    """A length of time of a command line. Raises ValueError, ArgumentTypeError."""
    value = float(text)
    if not 0.0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"{text}: choose a number of seconds from 0")
    return value


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
        "--jobs", metavar="N", type=number, default=os.cpu_count() or 1, help="so many at a time (default: cores)"
    )
    parser.add_argument("--cluster", metavar="ADDRESS", help="a Dask cluster instead, such as tcp://scheduler:8786")


def number(text: str) -> int:
    """A number of things of a command line, 1 or more. Raises ValueError, ArgumentTypeError."""
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text}: choose at least 1")
    return value


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
