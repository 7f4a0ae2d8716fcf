# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What a scan costs in the local lane, and whether the map depends on the thread of the global lane.

    .venv/bin/python bench/latency.py RECORDING...

Milliseconds are CPU time of the thread that takes the scans: other work on the machine does not count, nor what it
waits for the global lane where a recording is replayed faster than it was made.
"""

import argparse
import hashlib
import tempfile
import time
from pathlib import Path

import numpy as np

from oort import Session, open_recording, read_parameters, save_map


def measure(path: str, threaded: bool) -> tuple[list[float], str]:
    """CPU seconds of each scan, and the digest of the saved map."""
    parameters = read_parameters()
    parameters.set("global_slam_thread", threaded)
    recording = open_recording(path)
    session = Session(parameters, recording.sensor_on_base)
    session.start()
    seconds = []
    for scan in recording.scans():
        started = time.thread_time()
        session.add_scan(scan)
        seconds.append(time.thread_time() - started)
    session.stop()
    with tempfile.TemporaryDirectory() as folder:
        save_map(f"{folder}/map", session.map)
        digest = hashlib.md5(Path(folder, "map.map_capnp").read_bytes(), usedforsecurity=False).hexdigest()
    return seconds, digest


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Latency of the local lane, with the thread of the global lane.")
    parser.add_argument("recordings", nargs="+")
    print("| recording | scans | P50, ms | P99, ms | worst, ms | the same map without the thread |")
    print("|---|---|---|---|---|---|")
    for path in parser.parse_args().recordings:
        seconds, digest = measure(path, threaded=True)
        same = measure(path, threaded=False)[1] == digest
        p50, p99, worst = 1e3 * np.percentile(seconds, [50, 99, 100])
        print(
            f"| {Path(path).name} | {len(seconds)} | {p50:.2f} | {p99:.2f} | {worst:.1f} | {'yes' if same else 'NO'} |"
        )


if __name__ == "__main__":
    main()
