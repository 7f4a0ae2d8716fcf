# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated drive as files: bags, CARMEN log, true trajectory, events and a picture, with the same stamps in all."""

import json
import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from oort.poses import compose
from oort.simulate.bag import write_bag, write_mcap, write_ros2_bag
from oort.simulate.drive import Drive
from oort.simulate.picture import draw_home

HOST = "simulation"
LASER_TYPE = 99  # CARMEN's number of an unknown proximity sensor

Write = Callable[[Drive, Path], None]
DEFAULT_FORMATS = ("ros1", "carmen")


def write_drive(
    drive: Drive, folder: Path, name: str, picture: bool = True, formats: Sequence[str] = DEFAULT_FORMATS
) -> list[Path]:
    """Write the drive in some of FORMATS, with ``name``.truth.tum, .events.json and, if wanted, .png, into a folder.

    The folder is made. There is no CARMEN log of a sensor that sweeps, for it cannot tell when each beam was measured.
    Files of the same name are replaced, each only when its successor is complete. Returns the paths. Raises OSError,
    and ValueError for an unknown format.
    """
    for unknown in set(formats) - set(FORMATS):
        raise ValueError(f"format {unknown!r}: choose of {', '.join(FORMATS)}")
    writes = dict(FORMATS[each] for each in FORMATS if each in formats)
    if drive.config.sensor.sweep_seconds > 0.0:
        writes.pop(FORMATS["carmen"][0], None)
    writes |= {".truth.tum": write_truth, ".events.json": write_events}
    if picture:
        writes[".png"] = draw_home
    folder.mkdir(parents=True, exist_ok=True)
    return [_write_whole(drive, folder / (name + ending), write) for ending, write in writes.items()]


def write_carmen(drive: Drive, path: Path) -> None:
    """Write ROBOTLASER1 lines; no return is written as the maximum range, stamps with six decimals.

    A line: laser_type start_angle field_of_view angular_resolution maximum_range accuracy remission_mode,
    n and n readings, m and m remissions (none), laser pose, robot pose (by odometry), tv rv forward_safety_dist
    side_safety_dist turn_axis ipc_timestamp hostname logger_timestamp. The field of view is the angle from the first
    beam to the last.
    """
    path.write_text("".join(_carmen_lines(drive)), encoding="ascii")


def write_truth(drive: Drive, path: Path) -> None:
    """Write the base's true pose in the map frame at each scan: t x y z qx qy qz qw (the TUM format)."""
    lines = [
        f"{_seconds(stamp)} {x:.9f} {y:.9f} 0 0 0 {np.sin(0.5 * heading):.12f} {np.cos(0.5 * heading):.12f}\n"
        for stamp, (x, y, heading) in zip(drive.scan_stamps, drive.T_map_base.tolist(), strict=True)
    ]
    path.write_text("".join(lines), encoding="ascii")


def write_events(drive: Drive, path: Path) -> None:
    """Write the drive's service calls as a JSON list of ``{"t": seconds, "call": name, "args": [...]}``."""
    entries = [{"t": event.t, "call": event.call, "args": list(event.args)} for event in drive.events]
    path.write_text(json.dumps(entries, indent=1) + "\n", encoding="ascii")


def _carmen_lines(drive: Drive) -> Iterator[str]:
    sensor = drive.config.sensor
    span = (sensor.beams - 1) * drive.angle_increment
    reach = repr(float(drive.range_max))
    head = f"ROBOTLASER1 {LASER_TYPE} {drive.angle_min:.9f} {span:.9f} {drive.angle_increment:.9f} {reach}"
    head += f" {sensor.noise:.3f} 0 {sensor.beams}"
    robot = drive.T_odom_base_at_scans
    laser = compose(robot, drive.T_base_sensor)
    for stamp, ranges, *poses in zip(drive.scan_stamps, drive.ranges, laser, robot, strict=True):
        readings = " ".join(f"{r:.3f}" if r < drive.range_max else reach for r in ranges.tolist())
        place = " ".join(f"{value:.9f}" for pose in poses for value in pose)
        time = _seconds(stamp)
        yield f"{head} {readings} 0 {place} 0 0 0 0 0 {time} {HOST} {time}\n"


def _seconds(stamp: np.int64) -> str:
    """A stamp [ns] of whole microseconds, exactly, in seconds."""
    seconds, nanoseconds = divmod(int(stamp), 10**9)
    return f"{seconds}.{nanoseconds // 1000:06d}"


def _write_whole(drive: Drive, path: Path, write: Write) -> Path:
    """Write in a folder beside the file first, so that an interruption leaves no half file under its name."""
    beside = path.with_name(f".{path.name}.partial")
    _remove(beside)  # of a call that was killed
    beside.mkdir()
    try:
        partial = beside / path.name
        write(drive, partial)
        if path.is_dir() and partial.is_dir():
            _remove(path)  # a folder cannot be put in the place of another
        os.replace(partial, path)
    finally:
        _remove(beside)
    return path


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


FORMATS: dict[str, tuple[str, Write]] = {
    "ros1": (".bag", write_bag),
    "ros2": ("", write_ros2_bag),
    "mcap": (".mcap", write_mcap),
    "carmen": (".clf", write_carmen),
}
"""kinds of recordings, each with its ending; a ROS 2 bag is a folder"""
