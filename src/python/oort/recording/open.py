# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Finds out what kind of recording a path is and opens it."""

import math
import os
from dataclasses import replace
from pathlib import Path

from oort._core import Parameters
from oort.errors import InputError, ParameterError
from oort.recording.bag import read_bag
from oort.recording.carmen import read_carmen
from oort.recording.types import Recording

ACCEPTED = (
    "a CARMEN log (plain, .gz or .bz2), a ROS 1 bag (.bag), a ROS 2 bag (the directory with metadata.yaml, or its "
    ".mcap or .db3 file)"
)
"""What `open_recording` reads, as a phrase for messages."""

_COMPRESSED = (".gz", ".bz2")
_SUFFIXES = (".clf", ".carmen", ".log", ".txt", ".bag", ".mcap", ".db3")
_BAG_MAGIC = {  # first bytes -> the suffix that the bag library knows this kind by, and its name
    b"#ROSBAG V2.0\n": (".bag", "ROS 1 bag"),
    b"\x89MCAP0\r\n": (".mcap", "ROS 2 bag"),
    b"SQLite format 3\0": (".db3", "ROS 2 bag"),
}
_COMPRESSED_MAGIC = (b"\x1f\x8b", b"BZh")


def open_recording(
    path: str | os.PathLike[str],
    *,
    scan_topic: str | None = None,
    odom_frame: str | None = None,
    imu_topic: str | None = None,
    max_range: float | None = None,
    parameters: Parameters | None = None,
) -> Recording:
    """Opens a recording and looks through all of it once.

    `scan_topic` chooses among several laser scans: a bag's topic, or a CARMEN log's message (FLASER, ROBOTLASER1).
    `odom_frame` names a bag's odometry frame where it is not called "odom", and `imu_topic` the IMU whose gyro takes
    the place of its turns. Of `parameters` (default: Parameters()) those count that say what is made of odometry:
    use_imu, which takes the bag's only IMU, motion_compensation and max_extrapolation. Readings at or beyond
    `max_range` [m] are no return.

    Raises InputError if the recording is missing, damaged, cut short, ambiguous, or without scans or odometry, and
    ParameterError if `max_range` is not a positive number.
    """
    path = Path(path)
    if max_range is not None and not (math.isfinite(max_range) and max_range > 0.0):
        raise ParameterError(f"max_range must be a positive number of metres, not {max_range}")
    bag_kind = _bag_kind(path)
    if bag_kind is None:
        if odom_frame is not None:
            raise ParameterError(f"{path} is a CARMEN log: it has no frames, so leave out odom_frame")
        if imu_topic is not None:
            raise ParameterError(f"{path} is a CARMEN log: it has no IMU, so leave out imu_topic")
        recording = read_carmen(path, name=recording_name(path), message=scan_topic, max_range=max_range)
        if parameters is not None and parameters.get("use_imu"):
            note = "a CARMEN log has no IMU: use_imu has no effect, turns are those of odometry"
            recording = replace(recording, notes=(*recording.notes, note))
        return recording
    return read_bag(
        path,
        name=recording_name(path),
        kind=bag_kind,
        scan_topic=scan_topic,
        odom_frame=odom_frame,
        imu_topic=imu_topic,
        max_range=max_range,
        parameters=parameters or Parameters(),
    )


def recording_name(path: Path) -> str:
    """The base name without the suffixes of recordings: intel.clf.bz2 -> intel."""
    name = path.resolve().name
    for suffixes in (_COMPRESSED, _SUFFIXES):
        stem, suffix = os.path.splitext(name)
        if stem and suffix.lower() in suffixes:
            name = stem
    return name


def _bag_kind(path: Path) -> str | None:
    """The kind of bag, or None for what may be a CARMEN log. Raises InputError for everything else."""
    if path.is_dir():
        if not (path / "metadata.yaml").is_file():
            raise InputError(f"{path} is a directory without metadata.yaml, so not a ROS 2 bag; accepted is {ACCEPTED}")
        return "ROS 2 bag"
    try:
        with path.open("rb") as stream:
            head = stream.read(4096)
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}; check the path") from None
    if not head:
        raise InputError(f"{path} is empty; copy it again, or record it again")
    for magic, (suffix, kind) in _BAG_MAGIC.items():
        if head.startswith(magic):
            if path.suffix != suffix:
                raise InputError(f"{path} is a {kind}, but not named so; rename it to end in {suffix}")
            return kind
    if path.suffix.lower() in (".bag", ".mcap", ".db3"):
        raise InputError(f"{path} does not begin as a {path.suffix} file does: it is damaged or something else")
    if not head.startswith(_COMPRESSED_MAGIC) and b"\0" in head:
        raise InputError(f"{path} is of an unknown kind; accepted is {ACCEPTED}")
    return None
