# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Kills a mapping process at random instants, again and again, and looks at what is on the disk.

    .venv/bin/python bench/kills.py [--count N] [--seed N]

A process maps a drive at one path and saves all the time. After each kill -9 the map there must be whole, and as new
as the last save that the process told of; the next process begins beside it (the map is kept as .previous) and goes on.
Prints the kills, how often there was no map yet, and the losses; the exit status is 1 if anything was lost.
"""

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

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


def kill_often(count: int, seed: int) -> Counts:
    """Kills so many processes."""
    rng = np.random.Generator(np.random.PCG64(seed))
    without_map, lost = 0, []
    with tempfile.TemporaryDirectory() as folder:
        base = f"{folder}/home"
        for k in range(count):
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
    return Counts(count, without_map, lost)


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
    args = parser.parse_args()
    counts = kill_often(args.count, args.seed)
    print(f"{counts.kills} kills, {counts.without_map} before the first save, {len(counts.lost)} losses")
    print("\n".join(counts.lost))
    return int(bool(counts.lost))


if __name__ == "__main__":
    sys.exit(main())
