# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A robot that stands on its dock, mapping, while a person walks by: what a day of that adds to the map.

    .venv/bin/python bench/parked.py [--hours N] [--home SEED]

A drive through one simulated home first, then the hours in fast time, ten scans a second; wheels stand still. Twenty
minutes of what the sensor truly sees are repeated, each time with other noise. Prints a row for each hour.
"""

import argparse
import os
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from oort import Session
from oort.parameters import read_parameters
from oort.poses import Array, compose
from oort.recording import Scan
from oort.simulate import Drive, SimulationConfig, simulate_drive
from oort.simulate.person import LEG_RADIUS, walk_along
from oort.simulate.sensor import cast_drive, measure
from trials.drives import recording_of, scan_at

RATE = 10  # scans a second
REPEATED = 20 * 60 * RATE  # scans
PACE, CLOSEST, AWAY = 0.9, 0.6, 4.0  # m/s, m, m of the person
EVERY = 45.0  # s between visits


def person(drive: Drive) -> Array:
    """Legs (n, 2, 2) at each scan, NaN while nobody is there: comes by the robot's way to the dock, and goes again."""
    place = drive.T_map_base[-1, :2]
    way = drive.T_map_base[:, :2]
    far = int(np.argmax(np.hypot(*(way - way[0]).T) > AWAY))
    coming = way[:far][::-1]
    coming = coming[np.hypot(*(coming - place).T) > CLOSEST]
    visit = walk_along(np.vstack([coming, coming[::-1]]), PACE / RATE)
    legs = np.full((REPEATED, 2, 2), np.nan)
    for start in range(0, REPEATED - len(visit), int(EVERY * RATE)):
        legs[start : start + len(visit)] = visit
    return legs


def parked_scans(drive: Drive, hours: int) -> Iterator[Scan]:
    """What the sensor tells from the end of the drive on."""
    sensor = drive.config.sensor
    eye = compose(drive.T_map_base[-1], drive.T_base_sensor)
    home = drive.home
    seen = cast_drive(sensor, np.tile(eye, (REPEATED, 1)), home.segments, home.discs, person(drive), LEG_RADIUS)
    x, y, theta = drive.T_odom_base_at_scans[-1].tolist()
    rng = np.random.default_rng(drive.seed)
    start = drive.scan_times[-1]
    for number in range(hours * 3600 * RATE):
        at = number % REPEATED
        if at == 0:
            ranges = measure(sensor, *seen, rng)
        stamp = start + (number + 1) / RATE
        yield scan_at(drive, stamp, ranges[at], (x, y, theta))


def memory_mb() -> float:
    """What is resident now."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=int, default=24)
    parser.add_argument("--home", type=int, default=3, metavar="SEED")
    arguments = parser.parse_args()
    drive = simulate_drive(arguments.home, SimulationConfig(odometry_error=2.0, minutes=3.0))
    recording = recording_of(drive, "drive")
    session = Session(read_parameters(), recording.sensor_on_base)
    session.start()
    for scan in recording.scans():
        session.add_scan(scan)

    print("| hour | nodes | closures | CPU, s | longest scan, CPU ms | memory, MB | files | threads |")
    print("|---|---|---|---|---|---|---|---|")
    longest, cpu = 0.0, time.process_time()
    for number, scan in enumerate(parked_scans(drive, arguments.hours)):
        if number % (3600 * RATE) == 0:
            report(session, number // (3600 * RATE), time.process_time() - cpu, longest)
            longest, cpu = 0.0, time.process_time()
        started = time.thread_time()
        session.add_scan(scan)
        session.observe(scan)
        longest = max(longest, time.thread_time() - started)
    report(session, arguments.hours, time.process_time() - cpu, longest)
    session.stop()
    print(f"after the stop: {session.mapper.num_nodes} nodes")


def report(session: Session, hour: int, cpu: float, longest: float) -> None:
    """Prints a row."""
    closures = len(session.map.switchable_edges["i"])
    files, threads = (len(os.listdir(f"/proc/self/{kind}")) for kind in ("fd", "task"))
    print(
        f"| {hour} | {session.mapper.num_nodes} | {closures} | {cpu:.1f} | {1e3 * longest:.2f} | {memory_mb():.1f} | "
        f"{files} | {threads} |",
        flush=True,
    )


if __name__ == "__main__":
    main()
