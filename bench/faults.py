# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Runs hostile inputs against the tools and the library, each in a process of its own, and prints a row for each.

    OORT_FAULT_CASES=DIR .venv/bin/python bench/faults.py [NAME...]

DIR holds the small inputs (maps, logs, event files). A case passes if what it expects holds, it ends with status 0 or
2, prints no traceback and no more than 4 KB of errors, and uses no more time and memory than a run of its kind may:
CPU time, which a busy machine does not stretch, and ten times as much by the clock, after which it hangs.
The exit status is the number of cases that failed, at most 100.
"""

import argparse
import math
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).parent))

from hostile.cases import CASES, Case

_MEGABYTE = 1 << 20
_LONGEST_MESSAGE = 4096  # [bytes]
_HANGS = 10.0  # times the CPU time that it may use


class Outcome(NamedTuple):
    """What became of a case."""

    wrong: str
    """what is wrong; empty if nothing is"""
    told: str
    """the last line of what it said"""
    seconds: float
    """of CPU time"""
    megabytes: float


def run(case: Case, inputs: Path) -> Outcome:
    """Runs a case in a folder of its own."""
    with tempfile.TemporaryDirectory(prefix="oort-fault-") as folder:
        command = case.command(inputs, Path(folder))
        limit = case.address_space * _MEGABYTE
        started = time.monotonic()
        with open(f"{folder}/.out", "wb") as out:
            process = subprocess.Popen(
                command,
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=subprocess.STDOUT,
                env={**os.environ, **case.environment},
                start_new_session=True,
                preexec_fn=lambda: _limit(limit, math.ceil(case.seconds) + 1),
            )
        status, seconds, megabytes = _wait(process, started + _HANGS * case.seconds)
        text = Path(folder, ".out").read_bytes()
    said = text.decode(errors="replace")
    last = (said.strip().splitlines() or [""])[-1]
    return Outcome(_judge(case, status, said, seconds, megabytes), last, seconds, megabytes)


def _limit(address_space: int, seconds: int) -> None:
    """What a process may use at most."""
    resource.setrlimit(resource.RLIMIT_AS, (address_space, address_space))
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))


def _wait(process: "subprocess.Popen[bytes]", deadline: float) -> tuple[int | None, float, float]:
    """The exit status, None if it had to be killed, and the CPU time [s] and the most memory [MB] that were used."""
    killed = False
    while True:
        pid, status, usage = os.wait4(process.pid, 0 if killed else os.WNOHANG)
        if pid:
            process.returncode = os.waitstatus_to_exitcode(status)
            seconds = usage.ru_utime + usage.ru_stime
            return None if killed else process.returncode, seconds, usage.ru_maxrss / 1024.0
        if time.monotonic() > deadline:
            os.killpg(process.pid, signal.SIGKILL)
            killed = True
        time.sleep(0.02)


def _judge(case: Case, status: int | None, said: str, seconds: float, megabytes: float) -> str:
    if status is None:
        return f"still runs after {_HANGS * case.seconds:.0f} s"
    if seconds > case.seconds:
        return f"{seconds:.0f} CPU s"
    if "Traceback (most recent call last)" in said and "AssertionError" not in said:
        return "traceback"
    if status not in case.statuses:
        return f"status {status}"
    if case.expected and case.expected not in said:
        return f"does not say {case.expected!r}"
    if len(said) > _LONGEST_MESSAGE and status != 0:
        return f"says {len(said)} bytes"
    if megabytes > case.megabytes:
        return f"{megabytes:.0f} MB"
    return ""


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description="Runs hostile inputs and prints a row for each.")
    parser.add_argument("names", nargs="*", help="some cases only")
    names = parser.parse_args().names
    if "OORT_FAULT_CASES" not in os.environ:
        parser.error("set OORT_FAULT_CASES to the folder with the inputs")
    inputs = Path(os.environ["OORT_FAULT_CASES"])
    failures = 0
    print("| row | case | verdict | CPU s | MB | said |\n|---|---|---|---|---|---|")
    for case in CASES:
        if names and case.name not in names and case.row not in names:
            continue
        outcome = run(case, inputs)
        failures += bool(outcome.wrong)
        verdict = f"FAIL: {outcome.wrong}" if outcome.wrong else "pass"
        told = outcome.told[:150].replace("|", "/")
        print(
            f"| {case.row} | {case.name} | {verdict} | {outcome.seconds:.1f} | {outcome.megabytes:.0f} | {told} |",
            flush=True,
        )
    print(f"\n{failures} failed")
    return min(failures, 100)


if __name__ == "__main__":
    sys.exit(main())
