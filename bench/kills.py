# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Kills a mapping process at random instants, again and again, and looks at what is on the disk.

    .venv/bin/python bench/kills.py [--count N] [--seed N] [--of session|replay]

session: a process maps a drive at one path with the live session of the nodes, and saves all the time. After each
kill -9 the map there must be whole, and as new as the last save that the process told of; the next process begins
beside it (the map is kept as .previous) and goes on.
replay: ``oort replay`` maps one of two drives over the map of the other. After each kill the map must be one of them,
whole, and no file of the results half written.

Prints the kills, how often there was no map yet, and the losses; the exit status is 1 if anything was lost.
"""

import argparse
import contextlib
import itertools
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

from hostile.drives import write_log
from oort import MapFileError, load_map

_CHILD = """
import sys
sys.path.insert(0, sys.argv[2])
from hostile.drives import scan_at
from oort import Parameters, Session
from oort.live import Listener, LiveSession

live = LiveSession(Parameters(), Listener(), draws=False)
live.call("map/start", [sys.argv[1]])
for k in range(100_000):
    live.add_scan(lambda k=k: scan_at(k))
    if k % 5 == 4:
        live.run(Session.save)
        print(live.snapshot.num_nodes, flush=True)
"""


class Counts(NamedTuple):
    """What became of kills."""

    kills: int
    without_map: int
    """before the first save"""
    lost: list[str]
    """what was lost, a sentence for each"""


def _until_interrupted(count: int) -> Iterator[int]:
    """Counts up; Ctrl-C ends it after the kill at hand."""
    ended = threading.Event()
    before = signal.signal(signal.SIGINT, lambda *_: ended.set())
    try:
        yield from itertools.takewhile(lambda _: not ended.is_set(), range(count))
    finally:
        signal.signal(signal.SIGINT, before)


def kill_often(count: int, seed: int) -> Counts:
    """Kills so many processes."""
    rng = np.random.Generator(np.random.PCG64(seed))
    without_map, lost = 0, []
    with tempfile.TemporaryDirectory() as folder:
        base = f"{folder}/home"
        for k in _until_interrupted(count):
            told = _run_and_kill(base, float(rng.uniform(0.0, 0.4)))
            try:
                nodes = len(load_map(base))
            except MapFileError as error:
                nodes = 0
                without_map += told == 0
                if told or any(os.path.lexists(base + ending) for ending in (".md5", ".map_capnp")):
                    lost.append(f"kill {k}: {error}")
            if nodes < told:
                lost.append(f"kill {k}: {told} nodes were told as saved, {nodes} are there")
            if sorted(Path(folder).glob("*.tmp")):
                lost.append(f"kill {k}: temporary files are left")
    return Counts(k + 1, without_map, lost)


def kill_replays(count: int, seed: int) -> Counts:
    """Kills so many replays."""
    rng = np.random.Generator(np.random.PCG64(seed))
    without_map, lost = 0, []
    with tempfile.TemporaryDirectory() as folder:
        logs, whole = [f"{folder}/{name}.clf" for name in ("short", "long")], []
        for log, scans in zip(logs, (60, 200), strict=True):
            write_log(log, scans)
            subprocess.run(_replay(log, f"{folder}/{scans}", f"{folder}/out"), check=True, stdout=subprocess.DEVNULL)
            whole.append(len(load_map(f"{folder}/{scans}")))
        base, out = f"{folder}/home", Path(folder, "out")
        longest = 2.0  # [s] of a replay; learned, for it depends on what else the machine does
        for k in _until_interrupted(count):
            with subprocess.Popen(_replay(logs[k % 2], base, str(out)), stdout=subprocess.DEVNULL) as child:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    child.wait(longest * float(rng.uniform(0.1, 1.0)))
                longest *= 1.05 if child.poll() is None else 0.8
                child.kill()
            try:
                nodes = len(load_map(base))
            except MapFileError as error:
                nodes = 0
                without_map += 1
                if any(os.path.lexists(base + ending) for ending in (".md5", ".map_capnp")):
                    lost.append(f"kill {k}: {error}")
            if nodes and nodes not in whole:
                lost.append(f"kill {k}: {nodes} nodes, not {whole}")
            lost += [f"kill {k}: {path} is half written" for path in out.glob("*.json") if not _is_json(path)]
    return Counts(k + 1, without_map, lost)


def _replay(log: str, base: str, out: str) -> list[str]:
    return [sys.executable, "-m", "oort.replay", log, "--map", base, "--out", out, "--quiet"]


def _is_json(path: Path) -> bool:
    try:
        json.loads(path.read_text())
    except ValueError:
        return False
    return True


def _run_and_kill(base: str, seconds: float) -> int:
    """Runs a process so long after it began to map; how many nodes it told as saved."""
    command = [sys.executable, "-c", _CHILD, base, str(Path(__file__).parent)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        first = child.stdout.readline() if seconds > 0.1 else ""  # some are killed while they begin
        time.sleep(seconds)
        child.send_signal(signal.SIGKILL)
        rest = child.stdout.read()
    lines = [line for line in (first + rest).splitlines(keepends=True) if line.endswith("\n")]
    return int(lines[-1]) if lines else 0


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description="Kills mapping processes and looks at what they leave.")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--of", choices=["session", "replay"], default="session")
    args = parser.parse_args()
    counts = (kill_often if args.of == "session" else kill_replays)(args.count, args.seed)
    print(f"{counts.kills} kills, {counts.without_map} before the first save, {len(counts.lost)} losses")
    print("\n".join(counts.lost))
    return int(bool(counts.lost))


if __name__ == "__main__":
    sys.exit(main())
