# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Command line of the simulator: ``oort simulate`` or ``python -m oort.simulate``."""

import argparse
import math
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from oort.simulate.drive import FAULTS, SCENES, Drive, SimulationConfig, simulate_drive
from oort.simulate.sensor import DRIVERS, Sensor
from oort.simulate.writers import write_drive


def main(argv: Sequence[str] | None = None) -> int:
    """Simulate a drive, write its files and print a summary. Returns the exit status: 0, or 2 after an error."""
    arguments = _parser().parse_args(argv)
    try:
        sensor = Sensor(
            field_of_view=math.radians(arguments.fov),
            beams=round(arguments.fov) if arguments.beams is None else arguments.beams,
            range_max=arguments.max_range,
            sweep_seconds=arguments.sweep,
            driver=arguments.driver,
            body=math.radians(arguments.body),
        )
        config = SimulationConfig(
            sensor,
            arguments.odometry_error,
            arguments.person,
            arguments.minutes,
            arguments.scene,
            arguments.fault,
            arguments.way,
            gyro=arguments.gyro,
            turn_error=arguments.turn_error,
            moved=arguments.moved,
            rear=arguments.rear,
            arrangement=arguments.arrangement,
            doors=arguments.doors,
        )
        drive = simulate_drive(arguments.seed, config)
        name = arguments.name or f"{arguments.scene}_{arguments.seed}"
        paths = write_drive(drive, arguments.out, name, arguments.picture)
    except (OSError, ValueError) as error:
        print(f"oort simulate: {error}", file=sys.stderr)
        return 2
    print(_summary(drive))
    for path in paths:
        print(path)
    if sensor.sweep_seconds:
        print("no CARMEN log: it could not tell when each beam of a sweep was measured")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="oort simulate",
        epilog="Example: oort simulate --seed 3 --out drives",
        description="Simulate a robot's drive through a made-up home: scans, odometry and the truth.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    parser.add_argument("--seed", type=int, default=0, help="the home and all that is random follow from it")
    parser.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="where the files go")
    parser.add_argument("--name", help="the files' name without ending; SCENE_SEED if not given")
    parser.add_argument("--scene", choices=SCENES, default=SCENES[0], help="what the robot drives through")
    parser.add_argument("--fault", choices=FAULTS, default=FAULTS[0], help="what goes wrong once on the way")
    parser.add_argument("--odometry-error", type=float, default=1.0, metavar="F", help="0: none, 3: a bad base")
    parser.add_argument("--turn-error", type=float, default=1.0, metavar="F", help="one more factor on that of turns")
    parser.add_argument("--fov", type=float, default=180.0, metavar="DEG", help="field of view, straight ahead")
    parser.add_argument("--beams", type=int, metavar="N", help="beams over it; one per degree if not given")
    parser.add_argument("--max-range", type=float, default=3.0, metavar="M", help="metres that the sensor sees")
    parser.add_argument("--sweep", type=float, default=0.0, metavar="S", help="seconds that a scan takes; then no .clf")
    parser.add_argument("--driver", choices=DRIVERS, default=DRIVERS[0], help="how the sensor's driver tells scans")
    parser.add_argument(
        "--body", type=float, default=0.0, metavar="DEG", help="the robot seen at both edges of the view"
    )
    parser.add_argument("--rear", action="store_true", help="a second sensor looks back: /scan_rear in the bag")
    parser.add_argument("--gyro", action="store_true", help="the robot has a gyro: /imu in the bag")
    parser.add_argument("--minutes", type=float, default=3.0, help="drive on after the tour until about then")
    parser.add_argument("--no-person", dest="person", action="store_false", help="nobody crosses the view")
    parser.add_argument("--way", type=int, default=0, metavar="N", help="another drive through the same home")
    parser.add_argument("--moved", type=int, default=0, metavar="N", help="pieces of furniture moved since drive 0")
    parser.add_argument("--doors", action="store_true", help="doors stand open at other angles than on drive 0")
    parser.add_argument(
        "--arrangement", type=int, default=0, metavar="N", help="what is moved follows from N, not from --way"
    )
    parser.add_argument("--picture", action=argparse.BooleanOptionalAction, default=True, help="write a PNG too")
    return parser


def _summary(drive: Drive) -> str:
    rooms = Counter(room.kind for room in drive.home.rooms)
    named = ", ".join(f"{count} x {kind}" if count > 1 else kind for kind, count in sorted(rooms.items()))
    distance, heading = drive.odometry_error_at_end
    return (
        f"{len(drive.home.rooms)} rooms ({named}), {drive.home.area:.0f} m2\n"
        f"{drive.duration / 60.0:.1f} minutes, {len(drive.scan_stamps)} scans, {drive.length:.1f} m driven\n"
        f"odometry at the end off by {distance:.2f} m and {math.degrees(heading):+.1f} degrees"
    )
