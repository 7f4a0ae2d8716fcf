# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Sensors of home robots in simulated homes: how far the map is off the truth, and what mapping costs.

    .venv/bin/python bench/sensors.py [--homes N] [--jobs N]

The same homes and ways for each, odometry three times worse than a good base's, default parameters. Figures of the
sensors are those of their data sheets, rounded; noise is the simulator's unless the sheet says otherwise.
"""

import argparse
import datetime
import math
import tempfile
import time
from functools import partial
from pathlib import Path

import numpy as np

from oort import Parameters
from oort.evaluation.trajectories import evaluate_ate
from oort.export import Trajectory, read_tum
from oort.recording import open_recording
from oort.simulate import Sensor, SimulationConfig, simulate_drive
from oort.simulate.writers import write_drive
from trials.replays import replay
from trials.rows import BROKEN
from trials.tables import print_table
from trials.workers import Failure, run_all

SENSORS = {
    "short range, as Kuri's: 180°, 3 m": Sensor(),
    "depth camera, as RealSense: 87°, 4 m": Sensor(math.radians(87), 87, 0.3, 4.0, noise=0.005, noise_per_metre=0.01),
    "spinning, as LD06 or RPLidar: 360°, 10 Hz, 8 m": Sensor(
        2.0 * math.pi, 450, 0.15, 8.0, noise=0.01, noise_per_metre=0.005, sweep_seconds=0.1
    ),
    "scanner, as Hokuyo URG: 270°, 5.6 m": Sensor(math.radians(270), 540, 0.06, 5.6, noise=0.01, noise_per_metre=0.005),
}


def measure(name: str, seed: int) -> tuple[float, float, float]:
    """Position error [m], CPU seconds, and milliseconds of the 99th percentile of a scan."""
    with tempfile.TemporaryDirectory() as place:
        drive = simulate_drive(seed, SimulationConfig(SENSORS[name], odometry_error=3.0))
        write_drive(drive, Path(place), "home", picture=False)
        started = time.process_time()
        replayed = replay(open_recording(f"{place}/home.bag"), Parameters())
        seconds = time.process_time() - started
        truth = read_tum(Path(place) / "home.truth.tum")
    stamps = tuple(replayed.drive.recorder.stamps)
    error = evaluate_ate(Trajectory(stamps, replayed.T_map_base), truth).position_rmse
    return error, seconds, 1e3 * float(np.percentile(replayed.seconds, 99))


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--homes", type=int, default=10, metavar="N", help="homes for each sensor (default: 10)")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="drives at once")
    arguments = parser.parse_args()
    keys = [(name, seed) for name in SENSORS for seed in range(1, arguments.homes + 1)]
    figures: dict[str, list[tuple[float, float, float]]] = {name: [] for name in SENSORS}
    for index, result in run_all([partial(measure, *key) for key in keys], arguments.jobs):
        if isinstance(result, Failure):
            raise SystemExit(f"{keys[index]}: {result.reason}")
        figures[keys[index][0]].append(result)
    rows = {}
    for name, values in figures.items():
        errors, seconds, late = np.array(values).T
        broken = int((errors > BROKEN).sum())
        rows[name] = [
            f"{np.median(errors):.3f} / {errors.max():.3f} m",
            str(broken),
            f"{seconds.mean():.1f} s",
            f"{late.max():.1f} ms",
        ]
    print(f"Taken on {datetime.date.today()}, {arguments.homes} homes each\n")
    print_table(("sensor", "ATE, median / worst", "broken maps", "CPU of a drive", "P99 of a scan, worst"), rows)


if __name__ == "__main__":
    main()
