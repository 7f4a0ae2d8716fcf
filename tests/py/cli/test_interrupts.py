# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C while a tool begins."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from oort.interrupts import interruptible

_PROGRAM = "import signal, oort; print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"


def _heard() -> None:
    signal.signal(signal.SIGINT, signal.default_int_handler)  # not ignored, as where a script's job began the tests


@pytest.mark.parametrize("command", [["-m", "oort.replay"], [str(Path(sys.executable).with_name("oort")), "replay"]])
def test_while_imports_go_on_it_ends_without_a_traceback(command: list[str]) -> None:
    words = [sys.executable, "-X", "importtime", *command, "none.bag"]
    with subprocess.Popen(words, stderr=subprocess.PIPE, text=True, preexec_fn=_heard) as process:
        assert process.stderr is not None
        next(line for line in process.stderr if line.endswith(" oort.errors\n"))
        process.send_signal(signal.SIGINT)
        rest = process.stderr.read()
    assert "Traceback" not in rest
    assert process.returncode in (-signal.SIGINT, 2)  # 2: it got on faster than this process


def test_a_program_that_imports_oort_hears_it_as_ever() -> None:
    done = subprocess.run([sys.executable, "-c", _PROGRAM], capture_output=True, text=True, preexec_fn=_heard)
    assert done.stdout == "True\n"


def test_it_ends_at_once_while_the_engine_computes() -> None:
    program = (
        "import ctypes, sys; sys.orig_argv = ['python', '-m', 'oort.merge']\n"
        "from oort.interrupts import interruptible, take_interrupts\n"
        "take_interrupts()\n"
        "with interruptible():\n"
        "    print('computing', flush=True)\n"
        "    ctypes.PyDLL(None).sleep(60)\n"  # as in the engine, no Python runs that would hear of it
    )
    words = [sys.executable, "-c", program]
    with subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=_heard
    ) as process:
        assert process.stdout is not None and process.stderr is not None
        assert process.stdout.readline() == "computing\n"
        process.send_signal(signal.SIGINT)
        assert process.wait(30) == -signal.SIGINT
        assert process.stderr.read() == ""


def test_what_is_interruptible_hears_it_as_ever_afterwards() -> None:
    before = signal.getsignal(signal.SIGINT)
    with interruptible():
        assert signal.getsignal(signal.SIGINT) is before  # no tool runs here
    assert signal.getsignal(signal.SIGINT) is before


def test_a_full_disk_is_of_the_output() -> None:
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "oort.parameters", "table"], stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert (done.returncode, done.stderr) == (2, "oort parameters: standard output: No space left on device\n")
