# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A session that never ends: round after round through one simulated home, without a stop.

    .venv/bin/python bench/endless.py [--rounds N] [--home SEED]

The rounds are the days of bench/lifelong.py: each has another way, another person and other noise, furniture moves now
and then. Prints a row for each five rounds, and after the stop how right trajectory and map are.
"""

import argparse
import time
from collections.abc import Iterator, Sequence

import numpy as np

from lifelong import cells_right, simulate_day
from oort import Session
from oort.offline.trajectory import TrajectoryRecorder
from oort.parameters import read_parameters
from oort.poses import Array, between, compose
from oort.recording import Scan
from oort.report.stopwatch import without_garbage_pauses
from oort.simulate import Drive
from parked import memory_mb
from trials.drives import recording_of, scan_at

ROWS = 5  # rounds
PAUSE = 0.1  # s between rounds


def scans_of(drive: Drive, stamp: float, odometry: Array, place: Array) -> Iterator[Scan]:
    """A round's scans, from a stamp on; the one before was at ``place`` on the map, and ``odometry`` by the wheels."""
    start = compose(odometry, between(place, drive.T_map_base[0]))
    first = drive.T_odom_base_at_scans[0]
    for index, time_ in enumerate((drive.scan_times - drive.scan_times[0]).tolist()):
        x, y, theta = compose(start, between(first, drive.T_odom_base_at_scans[index])).tolist()
        yield scan_at(drive, stamp + time_, drive.ranges[index], (x, y, theta))


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=60)
    parser.add_argument("--trajectory", action="store_true", help="keep it; all scans' places are then in the memory")
    parser.add_argument("--home", type=int, default=3, metavar="SEED")
    arguments = parser.parse_args()
    print("| rounds | nodes | closures | CPU of a round, s | longest scan, CPU ms | memory, MB |")
    print("|---|---|---|---|---|---|")
    stamp, odometry, place = 0.0, np.zeros(3), np.zeros(3)
    truth: list[Array] = []
    for number in range(arguments.rounds):
        drive = simulate_day(arguments.home, number, moves=4, every=10, minutes=4.0)
        if number == 0:
            mount = recording_of(drive, "endless").sensor_on_base
            session, recorder = Session(read_parameters(), mount), TrajectoryRecorder(mount)
            session.start()
            place = drive.T_map_base[0]
        if number % ROWS == 0:
            longest, cpu = 0.0, 0.0
        with without_garbage_pauses():
            for scan in scans_of(drive, stamp, odometry, place):
                started, all_started = time.thread_time(), time.process_time()
                result = session.add_scan(scan)
                longest = max(longest, time.thread_time() - started)
                cpu += time.process_time() - all_started
                if arguments.trajectory:
                    recorder.follow(session.mapper.take_renumbering())
                    recorder.add(scan.stamp, scan.odometry, result)
        stamp, odometry, place = scan.time + PAUSE, np.array(scan.odometry), drive.T_map_base[-1]
        truth.append(drive.T_map_base)
        if (number + 1) % ROWS == 0:
            closures = len(session.map.switchable_edges["i"])
            print(
                f"| {number + 1} | {session.mapper.num_nodes} | {closures} | {cpu / ROWS:.2f} | {1e3 * longest:.1f} | "
                f"{memory_mb():.0f} |",
                flush=True,
            )
    session.stop()
    print(f"after the stop: {session.mapper.num_nodes} nodes")
    if arguments.trajectory:
        recorder.follow(session.mapper.take_renumbering())
        tell_errors(recorder.base_poses(session.map), truth)
    print("precision and recall of the occupied cells: {:.3f}, {:.3f}".format(*cells_right(session.map, drive)))


def tell_errors(poses: Array, rounds: Sequence[Array]) -> None:
    """Of each round, by the truth, with no alignment."""
    errors = []
    for part in rounds:
        apart, poses = poses[: len(part)] - part, poses[len(part) :]
        errors.append(float(np.sqrt((apart[:, :2] ** 2).sum(axis=1).mean())))
    print(f"position error (RMSE) of a round: first {errors[0]:.3f}, last {errors[-1]:.3f}, worst {max(errors):.3f} m")


if __name__ == "__main__":
    main()
