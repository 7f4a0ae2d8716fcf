# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Sensors of home robots in simulated homes: how far the map is off the truth, and what mapping costs.

    .venv/bin/python bench/sensors.py [--homes N] [--jobs N]

The presets of `oort simulate`, each in the same homes and on the same ways, with odometry three times worse than a good
base's, and default parameters.
"""

import argparse
import datetime
import tempfile
import time
from functools import partial
from pathlib import Path

import numpy as np

from oort import Parameters
from oort.evaluation.trajectories import evaluate_ate
from oort.export import Trajectory, read_tum
from oort.recording import open_recording
from oort.simulate import PRESETS, SimulationConfig, simulate_drive
from oort.simulate.writers import write_drive
from trials.replays import replay
from trials.rows import BROKEN
from trials.tables import print_table
from trials.workers import Failure, run_all


def measure(name: str, seed: int) -> tuple[float, float, float]:
    """Position error [m], CPU seconds, and milliseconds of the 99th percentile of a scan."""
    with tempfile.TemporaryDirectory() as place:
        drive = simulate_drive(seed, SimulationConfig(PRESETS[name], odometry_error=3.0))
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
    keys = [(name, seed) for name in PRESETS for seed in range(1, arguments.homes + 1)]
    figures: dict[str, list[tuple[float, float, float]]] = {name: [] for name in PRESETS}
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
