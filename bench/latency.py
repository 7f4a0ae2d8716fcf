# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What a scan costs in the local lane, and whether the map depends on the thread of the global lane.

    .venv/bin/python bench/latency.py RECORDING...
    .venv/bin/python bench/latency.py --live SPEED RECORDING...

Milliseconds are CPU time of the thread that takes the scans: other work on the machine does not count, nor what it
waits for the global lane where a recording is replayed faster than it was made.

With --live each recording is played to a live session as a robot would, so many times faster. Milliseconds are then
wall time from a scan's arrival until its pose is told: of all scans, of those with which closures or a solution took
effect, and of those that came while notify_docked, called every 20 s of the recording, waited for its answer.
"""

import argparse
import hashlib
import tempfile
import threading
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from oort import Parameters, Session, open_recording, read_parameters, save_map
from oort.live import LiveSession
from oort.live.listener import Listener
from oort.live.snapshot import Snapshot
from oort.report.stopwatch import without_garbage_pauses

_DOCKING = 20.0  # [s] of the recording between calls


def measure(path: str, threaded: bool) -> tuple[list[float], str]:
    """CPU seconds of each scan, and the digest of the saved map."""
    parameters = read_parameters()
    parameters.set("global_slam_thread", threaded)
    recording = open_recording(path)
    session = Session(parameters, recording.sensor_on_base)
    session.start()
    seconds = []
    with without_garbage_pauses():
        for scan in recording.scans():
            started = time.thread_time()
            session.add_scan(scan)
            seconds.append(time.thread_time() - started)
    session.stop()
    with tempfile.TemporaryDirectory() as folder:
        save_map(f"{folder}/map", session.map)
        digest = hashlib.md5(Path(folder, "map.map_capnp").read_bytes(), usedforsecurity=False).hexdigest()
    return seconds, digest


class _Ear(Listener):
    """Notes when each scan's pose was told, and whether the map was corrected with it."""

    def __init__(self) -> None:
        self.told: list[float] = []
        self.corrected: list[bool] = []
        self.session: LiveSession | None = None

    def scan_taken(self, snapshot: Snapshot) -> None:
        """A scan was mapped."""
        self.told.append(time.monotonic())
        result = None if self.session is None else self.session.figures.last_result
        self.corrected.append(result is not None and result.corrected)


def play(path: str, speed: float) -> dict[str, NDArray[np.float64]]:
    """Wall seconds from a scan's arrival until its pose was told, by what happened meanwhile."""
    recording = open_recording(path)
    ear = _Ear()
    live = LiveSession(Parameters(), ear, draws=False)
    ear.session = live
    live.mount_sensor(recording.sensor_on_base)
    live.call("map/start", [""])
    arrived: list[float] = []
    docking: list[tuple[float, float]] = []

    def dock() -> None:
        began = time.monotonic()
        live.call("map/notify_docked")
        docking.append((began, time.monotonic()))

    callers: list[threading.Thread] = []
    began, next_call = time.monotonic(), _DOCKING
    first: float | None = None
    for scan in recording.scans():
        first = scan.time if first is None else first
        time.sleep(max(0.0, began + (scan.time - first) / speed - time.monotonic()))
        arrived.append(time.monotonic())
        live.add_scan(lambda scan=scan: scan)  # type: ignore[misc]
        if scan.time - first > next_call:
            next_call += _DOCKING
            callers.append(threading.Thread(target=dock))
            callers[-1].start()
    for caller in callers:
        caller.join()
    while len(live.inbox):
        time.sleep(0.01)
    started = time.monotonic()
    live.call("map/stop")
    print(f"{Path(path).name}: map/stop took {time.monotonic() - started:.2f} s", flush=True)
    live.close()
    delays, at = np.array(ear.told) - np.array(arrived), np.array(arrived)
    while_docking = np.zeros(len(at), dtype=np.bool_)
    for call, answer in docking:
        while_docking |= (at >= call) & (at <= answer)
    return {"all": delays, "corrected with it": delays[np.array(ear.corrected)], "while docking": delays[while_docking]}


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", nargs="+")
    parser.add_argument("--live", type=float, metavar="SPEED", help="play to a live session, so many times faster")
    arguments = parser.parse_args()
    if arguments.live is not None:
        rows = [
            (Path(path).name, what, row)
            for path in arguments.recordings
            for what, row in play(path, arguments.live).items()
        ]
        print("| recording | scans | how many | P50, ms | P99, ms | worst, ms |")
        print("|---|---|---|---|---|---|")
        for name, what, delays in rows:
            figures = (
                " | ".join(f"{1e3 * q:.1f}" for q in np.percentile(delays, [50, 99, 100])) if len(delays) else "| |"
            )
            print(f"| {name} | {what} | {len(delays)} | {figures} |")
        return
    print("| recording | scans | P50, ms | P99, ms | worst, ms | the same map without the thread |")
    print("|---|---|---|---|---|---|")
    for path in arguments.recordings:
        seconds, digest = measure(path, threaded=True)
        same = measure(path, threaded=False)[1] == digest
        p50, p99, worst = 1e3 * np.percentile(seconds, [50, 99, 100])
        print(
            f"| {Path(path).name} | {len(seconds)} | {p50:.2f} | {p99:.2f} | {worst:.1f} | {'yes' if same else 'NO'} |"
        )


if __name__ == "__main__":
    main()
