# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C while a tool is still being imported: it ends, and shows no traceback of Python's imports."""

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import PurePath

_COMMAND = "oort"


def end_without_a_word() -> None:
    """Lets Ctrl-C end this process if it runs one of Oort's tools, until take_interrupts()."""
    if _runs_a_tool() and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)


def take_interrupts() -> None:
    """Makes Ctrl-C a KeyboardInterrupt again, once there is somebody to catch it."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_DFL and _runs_a_tool():
        signal.signal(signal.SIGINT, signal.default_int_handler)


@contextmanager
def interruptible() -> Iterator[None]:
    """Lets Ctrl-C end a tool at once while the engine computes for seconds and nothing is written."""
    usual = signal.getsignal(signal.SIGINT)
    alone = threading.current_thread() is threading.main_thread() and _runs_a_tool()
    if not alone or usual is not signal.default_int_handler:
        yield
        return
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, usual)


def _runs_a_tool() -> bool:
    """Whether this is the command or ``python -m oort.TOOL``, not a program that imports Oort."""
    words = sys.orig_argv[1:]
    if PurePath((sys.argv or [""])[0]).name == _COMMAND:
        return True
    return "-m" in words[:-1] and words[words.index("-m") + 1].startswith(f"{_COMMAND}.")
