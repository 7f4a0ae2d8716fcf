# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What motion compensation and a gyro's turns are worth: simulated homes with and without them (docs/motion.md)."""

import argparse
import math
import statistics
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from oort import Parameters, Session, read_parameters
from oort.offline.trajectory import TrajectoryRecorder
from oort.poses import Array, between, compose
from oort.recording import open_recording
from oort.simulate import Sensor, SimulationConfig, simulate_drive
from oort.simulate.bag import write_bag

Figures = tuple[float, float, float]
"""RMSE of the position of the map's trajectory [m], of its turn over a second [degrees], of odometry's position [m]."""

ROUND = Sensor(field_of_view=2.0 * math.pi, beams=360)
SWEEPS = {
    "all beams at once": (0.0, True),
    "one after the other, taken as at once": (0.1, False),
    "one after the other, compensated": (0.1, True),
}


def position_error(told: Array, true: Array) -> float:
    """RMSE [m] of positions (n, 2) after the best rigid motion."""
    a, b = told[:, :2] - told[:, :2].mean(axis=0), true[:, :2] - true[:, :2].mean(axis=0)
    theta = math.atan2(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a * b))
    turned = compose([0.0, 0.0, theta], np.column_stack([a, np.zeros(len(a))]))[:, :2]
    return float(np.sqrt(np.mean(np.sum((turned - b) ** 2, axis=1))))


def run(seed: int, config: SimulationConfig, parameters: Parameters) -> Figures:
    """Maps a drive by way of its bag."""
    drive = simulate_drive(seed, config)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "drive.bag"
        write_bag(drive, path)
        recording = open_recording(path, parameters=parameters)
        session = Session(parameters, recording.sensor_on_base)
        session.start()
        session.create_location("dock", "dock")
        recorder = TrajectoryRecorder(recording.sensor_on_base)
        odometry = []
        for scan in recording.scans():
            recorder.add(scan.stamp, scan.odometry, session.add_scan(scan))
            odometry.append(scan.odometry)
    session.notify_docked()
    session.stop()
    told, true = np.asarray(recorder.base_poses(session.map)), drive.T_map_base
    second = between(between(true[:-10], true[10:]), between(told[:-10], told[10:]))
    turn = math.degrees(float(np.sqrt(np.mean(second[:, 2] ** 2))))
    return position_error(told, true), turn, position_error(np.array(odometry), true)


def tell(row: str, figures: Sequence[Figures]) -> None:
    """Prints a row of a table."""
    position, turn, odometry = zip(*figures, strict=True)
    print(
        f"| {row} | {statistics.median(odometry):.3f} | {statistics.median(position):.4f} | {max(position):.4f} | "
        f"{statistics.median(turn):.2f} |",
        flush=True,
    )


def main() -> None:
    """Runs one of the two tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("table", choices=("sweep", "gyro"))
    parser.add_argument("--homes", type=int, default=10)
    parser.add_argument("--turn-errors", type=float, nargs="+", default=[3.0, 10.0])
    parser.add_argument("--fov", type=float, default=180.0, help="of the rows with and without a gyro [deg]")
    args = parser.parse_args()
    seeds = range(1, args.homes + 1)
    print("| drives | odometry, m | position, median, m | worst, m | turn, degrees |\n|---|---|---|---|---|")
    parameters = read_parameters()
    if args.table == "sweep":
        for row, (seconds, compensates) in SWEEPS.items():
            parameters.set("motion_compensation", compensates)
            sensor = Sensor(ROUND.field_of_view, ROUND.beams, sweep_seconds=seconds)
            tell(row, [run(seed, SimulationConfig(sensor, odometry_error=3.0), parameters) for seed in seeds])
        return
    sensor = Sensor(field_of_view=math.radians(args.fov), beams=round(args.fov))
    for factor in args.turn_errors:
        config = SimulationConfig(sensor, minutes=0.0, gyro=True, turn_error=factor)
        for use_imu in (False, True):
            parameters.set("use_imu", use_imu)
            row = f"turns {factor:g} times worse, {'gyro' if use_imu else 'wheels'}"
            tell(row, [run(seed, config, parameters) for seed in seeds])


if __name__ == "__main__":
    main()
