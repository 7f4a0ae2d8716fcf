# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Finds out what kind of recording a path is and opens it."""

import math
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from oort._core import Parameters
from oort.errors import InputError, ParameterError
from oort.inputs import check_regular
from oort.recording.bag import read_bag
from oort.recording.carmen import read_carmen
from oort.recording.container import BAG_MAGIC, find_container
from oort.recording.foreign import name_foreign
from oort.recording.limits import ScanLimits
from oort.recording.packed import PACKED
from oort.recording.packed import SUFFIXES as PACKED_SUFFIXES
from oort.recording.types import Pose, Recording

ACCEPTED = (
    "a CARMEN log (plain, .gz, .bz2 or .zst), a ROS 1 bag (.bag), a ROS 2 bag (the directory with metadata.yaml, or "
    "its .mcap or .db3 file); bags may be packed (.gz, .bz2, .zst) too"
)
"""What `open_recording` reads, as a phrase for messages."""

_MAP = ".map_capnp"  # the ending of a saved map
_SUFFIXES = (".clf", ".carmen", ".log", ".txt", ".bag", ".mcap", ".db3")


def open_recording(
    path: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    *,
    scan_topic: str | Sequence[str] | None = None,
    scan_frame: str | None = None,
    odom_frame: str | None = None,
    imu_topic: str | None = None,
    mount: Pose | None = None,
    min_range: float | None = None,
    max_range: float | None = None,
    masks: Sequence[tuple[float, float]] = (),
    parameters: Parameters | None = None,
) -> Recording:
    """Opens a recording and looks through all of it once. Several paths are the parts of a bag that was split.

    `scan_topic` chooses among several laser scans: a bag's topic, or a CARMEN log's message (FLASER, ROBOTLASER1).
    Several topics of a bag are those of several lasers, all of which are used, each where its frame says; so are those
    of one topic in several frames.
    `odom_frame` names a bag's odometry frame where it is not called "odom", and `imu_topic` the IMU whose gyro takes
    the place of its turns. Of `parameters` (default: Parameters()) those count that say what is made of odometry:
    use_imu, which takes the bag's only IMU, motion_compensation, max_extrapolation and use_odometry. A recording whose
    odometry is missing, or never changes, has none (Recording.without_odometry); replay() then maps without.
    Readings at or beyond `max_range` [m], below `min_range` [m] and in the sectors of `masks` are no return
    (`ScanLimits`). `mount` is where the laser sits on the base (T_base_sensor), whatever the recording says;
    `scan_frame` chooses among the lasers of one topic.

    Raises InputError if the recording is missing, damaged, cut short, ambiguous, or without scans or odometry, and
    ParameterError for a limit or a mount that cannot be.
    """
    paths = [Path(path) for path in ([path] if isinstance(path, str | os.PathLike) else path)]
    if not paths:
        raise ParameterError("no recording was given")
    path = paths[0]
    if any("\0" in str(part) for part in paths):
        raise InputError(f"the recording's path holds a NUL character: {str(path)!r}")
    limits = ScanLimits(min_range, max_range, masks)
    if mount is not None and not all(map(math.isfinite, mount)):
        raise ParameterError(f"mount must be x, y [m] and theta [rad] of the laser on the base, not {mount}")
    for part in paths:
        _check_readable(part)
    topics = [scan_topic] if isinstance(scan_topic, str) else list(scan_topic or [])
    container = find_container(paths)
    if container is None:
        for option, value in (("odom_frame", odom_frame), ("scan_frame", scan_frame)):
            if value is not None:
                raise ParameterError(f"{path} is a CARMEN log: it has no frames, so leave out {option}")
        if imu_topic is not None:
            raise ParameterError(f"{path} is a CARMEN log: it has no IMU, so leave out imu_topic")
        return _open_carmen(path, topics, mount, limits, parameters)
    return read_bag(
        container,
        name=recording_name(container.path),
        scan_topics=topics,
        scan_frame=None if scan_frame is None else scan_frame.lstrip("/"),
        odom_frame=odom_frame,
        imu_topic=imu_topic,
        mount=mount,
        limits=limits,
        parameters=parameters or Parameters(),
    )


def _open_carmen(
    path: Path, messages: list[str], mount: Pose | None, limits: ScanLimits, parameters: Parameters | None
) -> Recording:
    """Opens a CARMEN log."""
    if len(messages) > 1:
        raise ParameterError(f"{path} is a CARMEN log: choose one of its messages with scan_topic, not {messages}")
    recording = read_carmen(
        path,
        name=recording_name(path),
        message=messages[0] if messages else None,
        mount=mount,
        limits=limits,
        use_odometry=parameters is None or bool(parameters.get("use_odometry")),
    )
    if parameters is not None and parameters.get("use_imu"):
        note = "a CARMEN log has no IMU: use_imu has no effect, turns are those of odometry"
        recording = replace(recording, notes=(*recording.notes, note))
    return recording


def recording_name(path: Path) -> str:
    """The base name without the suffixes of recordings: intel.clf.bz2 -> intel."""
    name = path.resolve().name
    for suffixes in (PACKED_SUFFIXES, _SUFFIXES):
        stem, suffix = os.path.splitext(name)
        if stem and suffix.lower() in suffixes:
            name = stem
    return name


def _check_readable(path: Path) -> None:
    """Raises InputError for what is neither a bag nor may be a CARMEN log."""
    if not path.exists() and path.with_name(f"{path.name}{_MAP}").is_file():
        raise InputError(f"{path} is a saved map; to go on with it, give a recording and --resume {path}")
    check_regular(path)
    if path.is_dir():
        return
    try:
        with path.open("rb") as stream:
            head = stream.read(4096)
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}; check the path") from None
    if not head:
        raise InputError(f"{path} is empty; copy it again, or record it again")
    if foreign := name_foreign(path, head):
        raise InputError(f"{path} is {foreign}")
    if path.name == "metadata.yaml" or head.startswith((*BAG_MAGIC, *PACKED)):
        return
    if path.suffix.lower() in (".bag", ".mcap", ".db3"):
        raise InputError(f"{path} does not begin as a {path.suffix} file does: it is damaged or something else")
    if b"\0" in head:
        raise InputError(f"{path} is of an unknown kind; accepted is {ACCEPTED}")
