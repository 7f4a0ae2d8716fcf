# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C while a tool begins."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

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
