# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``oort simulate``: makes up a home, or takes a floor plan, and drives a robot through it."""

import argparse
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from oort.cli.tool import Parser, add_json_argument, add_pose_argument, parse_arguments, print_result, run_tool
from oort.errors import InputError
from oort.simulate.drive import FAULTS, SCENES, Drive, SimulationConfig, simulate_drive
from oort.simulate.plan_files import read_plan
from oort.simulate.presets import MEANINGS, PRESETS
from oort.simulate.sensor import DRIVERS, Sensor
from oort.simulate.writers import DEFAULT_FORMATS, FORMATS, write_drive

_EXAMPLES = """Example: oort simulate --seed 3 --out drives; others:
  oort simulate --seed 3 --out drives                            a made-up home; oort replay drives/home_3.bag maps it
  oort simulate --sensor ld06 --format ros2 --out drives         another sensor, as a bag of ROS 2
  oort simulate --sensor realsense --tilt 3 --odometry-error 3   one that looks down, on a bad base
  oort simulate --plan flat.png --resolution 0.02                a home of one's own: dark is wall, light is floor
  oort simulate --plan maps/map.yaml --minutes 10                a map of map_server
  oort simulate --plan house.json --format mcap                  a house as ProcTHOR has it
  oort simulate --seed 3 --way 2 --moved 4 --doors               the home of seed 3 on another day
"""


def _sensor(args: argparse.Namespace) -> Sensor:
    """The preset with what else was asked for."""
    preset = PRESETS[args.sensor]
    changes: dict[str, Any] = {
        "range_max": args.max_range,
        "sweep_seconds": args.sweep,
        "driver": args.driver,
        "body": None if args.body is None else math.radians(args.body),
        "tilt": None if args.tilt is None else math.radians(args.tilt),
        "height": args.height,
        "beams": args.beams,
    }
    if args.fov is not None:
        changes["field_of_view"] = math.radians(args.fov)
        if args.beams is None:
            changes["beams"] = round(args.fov)
    return replace(preset, **{name: value for name, value in changes.items() if value is not None})


def _config(args: argparse.Namespace) -> SimulationConfig:
    return SimulationConfig(
        _sensor(args),
        args.odometry_error,
        args.person,
        args.minutes,
        args.scene,
        args.fault,
        args.way,
        gyro=args.gyro,
        turn_error=args.turn_error,
        moved=args.moved,
        rear=args.rear,
        arrangement=args.arrangement,
        doors=args.doors,
    )


def _run(args: argparse.Namespace) -> None:
    plan = None
    if args.plan is not None:
        plan = read_plan(args.plan, args.resolution, tuple(args.dock) if args.dock else None, args.assets)
    elif args.dock or args.resolution is not None or args.assets is not None:
        raise InputError("--dock, --resolution and --assets are of a floor plan; say which with --plan")
    name = args.name or f"{args.scene if plan is None else args.plan.stem}_{args.seed}"
    no_log = "no CARMEN log: it could not tell when each beam of a sweep was measured"
    try:
        config = _config(args)
        if config.sensor.sweep_seconds and list(args.format) == ["carmen"]:
            raise InputError(f"{no_log}; choose another --format, or a sensor without a sweep")
        drive = simulate_drive(args.seed, config, plan)
    except (ValueError, RuntimeError) as error:  # of numbers that cannot be; of a plan that the driver loses its way in
        raise InputError(str(error)) from None
    paths = [str(path) for path in write_drive(drive, args.out, name, args.picture, args.format)]
    notes = [] if plan is None else [f"note: {note}" for note in plan.notes]
    lines = [_summary(drive), *notes, *paths]
    if drive.config.sensor.sweep_seconds and "carmen" in args.format:
        lines.append(no_log)
    print_result(args, _figures(drive) | {"written": paths}, "\n".join(lines))


def _parser() -> argparse.ArgumentParser:
    presets = "\n".join(f"  {name:<11}{what}" for name, what in MEANINGS.items())
    parser = Parser(
        prog="oort simulate",
        description="Simulates a robot's drive through a home, made up or given: scans, odometry and the truth.",
        epilog=f"sensors:\n{presets}\n\n{_EXAMPLES}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--seed", type=int, default=0, help="the home and all that is random follow from it (default 0)"
    )
    _add_output_arguments(parser)
    _add_home_arguments(parser)
    _add_sensor_arguments(parser)
    _add_drive_arguments(parser)
    return parser


def _add_output_arguments(parser: argparse.ArgumentParser) -> None:
    output = parser.add_argument_group("output")
    output.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="where the files go (default: here)")
    output.add_argument("--name", help="the files' name without ending (default: SCENE_SEED, or PLAN_SEED)")
    output.add_argument(
        "--format",
        nargs="+",
        choices=list(FORMATS),
        default=list(DEFAULT_FORMATS),
        metavar="KIND",
        help=f"what is written: {', '.join(FORMATS)} (default: {' '.join(DEFAULT_FORMATS)}); ros2 is a folder",
    )
    output.add_argument(
        "--picture", action=argparse.BooleanOptionalAction, default=True, help="write a PNG too (default)"
    )
    add_json_argument(output)


def _add_home_arguments(parser: argparse.ArgumentParser) -> None:
    home = parser.add_argument_group("home")
    home.add_argument("--scene", choices=SCENES, default=SCENES[0], help="what is made up (default: %(default)s)")
    home.add_argument(
        "--plan",
        type=Path,
        metavar="FILE",
        help="a given home: a picture, a map of map_server, ProcTHOR's JSON",
    )
    home.add_argument("--resolution", type=float, metavar="M", help="metres of a picture's pixel")
    home.add_argument(
        "--assets", type=Path, metavar="FILE", help="ProcTHOR's asset-database.json: the sizes of a house's objects"
    )
    add_pose_argument(home, "--dock", "the docked base on the plan [m, rad]; at some wall if not given")
    home.add_argument("--way", type=int, default=0, metavar="N", help="another drive through the same home")
    home.add_argument("--moved", type=int, default=0, metavar="N", help="pieces of furniture moved since drive 0")
    home.add_argument("--doors", action="store_true", help="doors stand open at other angles than on drive 0")
    home.add_argument(
        "--arrangement", type=int, default=0, metavar="N", help="what is moved follows from N, not from --way"
    )
    home.add_argument("--no-person", dest="person", action="store_false", help="nobody crosses the view")


def _add_sensor_arguments(parser: argparse.ArgumentParser) -> None:
    sensor = parser.add_argument_group("sensor", "A preset, and what differs from it.")
    sensor.add_argument("--sensor", choices=list(PRESETS), default="kuri", help="one of those below (default: kuri)")
    sensor.add_argument("--fov", type=float, metavar="DEG", help="field of view, straight ahead")
    sensor.add_argument("--beams", type=int, metavar="N", help="beams over it; with --fov one per degree if not given")
    sensor.add_argument("--max-range", type=float, metavar="M", help="metres that the sensor sees")
    sensor.add_argument("--sweep", type=float, metavar="S", help="seconds that a scan takes; beyond 0 there is no .clf")
    sensor.add_argument("--driver", choices=DRIVERS, help="how the sensor's driver tells scans")
    sensor.add_argument("--body", type=float, metavar="DEG", help="the robot seen at both edges of the view")
    sensor.add_argument(
        "--tilt", type=float, metavar="DEG", help="it looks down, or up below 0; oort replay refuses more than 5"
    )
    sensor.add_argument("--height", type=float, metavar="M", help="above the floor, which it sees where it looks down")
    sensor.add_argument("--rear", action="store_true", help="a second one looks back: /scan_rear in a bag")
    sensor.add_argument("--gyro", action="store_true", help="the robot has a gyro: /imu in a bag")


def _add_drive_arguments(parser: argparse.ArgumentParser) -> None:
    drive = parser.add_argument_group("drive")
    drive.add_argument("--minutes", type=float, default=3.0, help="drive on after the tour until then (default: 3)")
    drive.add_argument(
        "--odometry-error", type=float, default=1.0, metavar="F", help="0: none, 1: a good base (default), 3: a bad"
    )
    drive.add_argument("--turn-error", type=float, default=1.0, metavar="F", help="one more factor on that of turns")
    drive.add_argument("--fault", choices=FAULTS, default=FAULTS[0], help="what goes wrong once on the way")


def _figures(drive: Drive) -> dict[str, Any]:
    distance, heading = drive.odometry_error_at_end
    return {
        "rooms": [{"kind": room.kind, "area": room.area} for room in drive.home.rooms],
        "area": drive.home.area,
        "seconds": drive.duration,
        "scans": len(drive.scan_stamps),
        "metres": drive.length,
        "odometry_off": [distance, heading],
    }


def _summary(drive: Drive) -> str:
    rooms = Counter(room.kind for room in drive.home.rooms)
    named = ", ".join(f"{count} x {kind}" if count > 1 else kind for kind, count in sorted(rooms.items()))
    distance, heading = drive.odometry_error_at_end
    return (
        f"{len(drive.home.rooms)} {'room' if len(drive.home.rooms) == 1 else 'rooms'} ({named}), "
        f"{drive.home.area:.0f} m2\n"
        f"{drive.duration / 60.0:.1f} minutes, {len(drive.scan_stamps)} scans, {drive.length:.1f} m driven\n"
        f"odometry at the end off by {distance:.2f} m and {math.degrees(heading):+z.1f} degrees"
    )


def main(argv: Sequence[str] | None = None) -> int:
    """Simulate a drive, write its files and print a summary. Returns the exit status: 0, or 2 after an error."""
    args = parse_arguments(_parser(), argv)
    return run_tool("oort simulate", lambda: _run(args), str(args.out))
