# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Reads CARMEN logs: text, one message a line, each ending in `ipc_timestamp hostname logger_timestamp`."""

import math
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from oort.errors import InputError
from oort.inputs import plain_number, quoted
from oort.poses import between, wrap_angle
from oort.recording.limits import ScanLimits
from oort.recording.packed import DAMAGED, PACKED
from oort.recording.rig import is_parked
from oort.recording.scan_fields import find_no_return
from oort.recording.types import Pose, Recording, Scan

_FLASER_MAX_RANGE = 80.0  # [m]; these lasers report 81.83 and 81.91 for no return
_SAMPLE = 400  # scans that are looked at more closely, spread over the log
_MOUNT_TOLERANCE = (0.02, 0.02)  # [m], [rad]: logs are written with as few as two decimals
_MOUNT_JITTER = (0.15, 0.15)  # [m], [rad] around the usual mount: 1 m/s and 1 rad/s with poses 0.15 s apart
_MOUNT_OUTLIERS = 0.05  # share of the scans that may lie beyond
_LONGEST_LINE, _LONGEST = 16 << 20, 4 << 30  # [bytes]
_LONGEST_COUNT = 9  # digits
_CUT = "The log is cut short here: copy it again, or remove this last line."


class _MalformedError(ValueError):
    """A line that does not hold what its message must."""


class _Reading(NamedTuple):
    scan: Scan
    laser: Pose  # T_odom_sensor


def read_carmen(
    path: Path, *, name: str, message: str | None, mount: Pose | None, limits: ScanLimits, use_odometry: bool = True
) -> Recording:
    """Reads a whole CARMEN log. `message` is FLASER or ROBOTLASER1, None for the one there is.

    Odometry that never changes is none.

    The sensor's place on the base is the difference of the laser's and the robot's pose in the first scan, or in most
    where it jitters; InputError if it changes over the log. The time of a scan is the ipc timestamp.
    """
    if message is not None and message not in _PARSERS:
        raise InputError(f"{path}: {message!r} is not a laser message of a CARMEN log; choose FLASER or ROBOTLASER1")
    readings, others, notes = _read_messages(path, message)
    filled = [reading for reading in readings if reading.scan.ranges.size]
    if not filled:
        found = ", ".join(f"{count} {keyword[:20]}" for keyword, count in others.most_common(6)) or "no message at all"
        raise InputError(
            f"{path}: no laser scans. Expected are lines that begin with {message or 'FLASER or ROBOTLASER1'}; found "
            f"{found}. Is it a CARMEN log?"
        )
    if len(filled) < len(readings):
        notes.append(f"scans skipped, without readings: {len(readings) - len(filled)}")
    scans, told = _limited([reading.scan for reading in filled], limits)
    notes += told
    without = _why_without_odometry(scans, use_odometry)
    if without:
        scans = [replace(scan, odometry=(0.0, 0.0, 0.0)) for scan in scans]
        notes.append(f"no odometry: {without}; the scans alone say how the base moves")
    if mount is not None:
        notes.append("the laser sits on the base where --mount says, whatever the log tells")
    else:
        mount, told = _mount(path, filled)
        notes += told
    return Recording(
        name=name,
        kind="CARMEN log",
        sensor_on_base=mount,
        num_scans=len(scans),
        notes=tuple(notes + _notes(scans, others)),
        source=lambda: iter(scans),
        without_odometry=without,
    )


def _read_messages(path: Path, message: str | None) -> tuple[list[_Reading], Counter[str], list[str]]:
    """All laser messages in the order of the lines, how many other messages there are, and notes."""
    readings: list[_Reading] = []
    others: Counter[str] = Counter()
    notes: list[str] = []
    for number, line in _lines(path):
        fields = line.split()
        if not fields or fields[0].startswith("#"):
            continue
        keyword = fields[0]
        cut = not line.endswith("\n")  # can only be so in the last line
        if keyword not in _PARSERS:
            if cut and any(known.startswith(keyword) for known in _PARSERS):
                raise InputError(f"{path}: line {number}: {keyword} and nothing more. {_CUT}")
            if cut:
                notes.append(f"the last line ({keyword}) has no end: the log may have been cut short there")
        elif message is None or keyword == message:
            message = keyword
            try:
                readings.append(_PARSERS[keyword](fields))
            except _MalformedError as error:
                raise InputError(
                    f"{path}: line {number}: {keyword} {error}. {_CUT if cut else 'Correct or remove the line.'}"
                ) from None
            continue
        others[keyword] += 1
    return readings, others, notes


def _lines(path: Path) -> Iterator[tuple[int, str]]:
    """Numbers from 1 and lines, each with its end."""
    number = 0
    try:
        with _open(path) as stream:
            size = 0
            while line := stream.readline(_LONGEST_LINE + 1):
                number += 1
                size += len(line)
                if len(line) > _LONGEST_LINE or size > _LONGEST:
                    raise InputError(
                        f"{path}: line {number} ends beyond what a CARMEN log can hold, {_LONGEST_LINE >> 20} MB a "
                        f"line and {_LONGEST >> 30} GB in all (unpacked); is it one?"
                    )
                yield number, line.decode("ascii", errors="replace")
    except EOFError:
        raise InputError(f"{path} is cut short: its compressed data end after line {number}; copy it again") from None
    except DAMAGED as error:
        raise InputError(f"{path} cannot be read beyond line {number} ({error}); copy it again") from None


def _open(path: Path) -> Any:
    with path.open("rb") as stream:
        head = stream.read(4)
    for magic, open_packed in PACKED.items():
        if head.startswith(magic):
            return open_packed(path)
    return path.open("rb")


def _parse_flaser(fields: list[str]) -> _Reading:
    """FLASER n r1..rn laser_x y theta robot_x y theta ipc_timestamp hostname logger_timestamp."""
    n = _count(fields, 1)
    _expect(fields, n + 11, f"of {n} readings")
    poses = _numbers(fields[n + 2 : n + 8])
    start, increment = flaser_angles(n)
    scan = Scan(
        time=_numbers(fields[n + 8 : n + 9])[0],
        stamp=fields[n + 8],
        angle_min=start,
        angle_increment=increment,
        range_min=0.0,
        range_max=_FLASER_MAX_RANGE,
        ranges=_ranges(fields[2 : n + 2]),
        odometry=(poses[3], poses[4], poses[5]),
    )
    return _Reading(scan, (poses[0], poses[1], poses[2]))


def flaser_angles(n: int) -> tuple[float, float]:
    """The bearing of the first reading and the step [rad] of a FLASER message, which carries no field of view.

    It is taken as the usual tools take it: from -90 degrees, by 1 degree for 180 and 181 readings, by half a degree
    for 360 and 361, else by 180 degrees / n.
    """
    steps = {180: 1.0, 181: 1.0, 360: 0.5, 361: 0.5}
    return -math.pi / 2, math.radians(steps[n] if n in steps else 180.0 / max(n, 1))


def _parse_robotlaser(fields: list[str]) -> _Reading:
    """ROBOTLASER1 laser_type start_angle field_of_view angular_resolution maximum_range accuracy remission_mode.

    Goes on with: n r1..rn m remission1..m laser_x y theta robot_x y theta tv rv forward_safety_dist side_safety_dist
    turn_axis ipc_timestamp hostname logger_timestamp.
    """
    n = _count(fields, 8)
    m = _count(fields, n + 9)
    _expect(fields, n + m + 24, f"of {n} readings and {m} remissions")
    _, start, _, increment, own_max_range = _numbers(fields[1:6])
    if own_max_range <= 0.0:
        raise _MalformedError(f"says that its maximum range is {own_max_range}")
    tail = n + m + 10
    poses = _numbers(fields[tail : tail + 6])
    scan = Scan(
        time=_numbers(fields[-3:-2])[0],
        stamp=fields[-3],
        angle_min=start,
        angle_increment=increment,
        range_min=0.0,
        range_max=own_max_range,
        ranges=_ranges(fields[9 : n + 9]),
        odometry=(poses[3], poses[4], poses[5]),
    )
    return _Reading(scan, (poses[0], poses[1], poses[2]))


_PARSERS: dict[str, Callable[[list[str]], _Reading]] = {
    "FLASER": _parse_flaser,
    "ROBOTLASER1": _parse_robotlaser,
}


def _count(fields: list[str], index: int) -> int:
    if index >= len(fields):
        raise _MalformedError(f"has only {len(fields)} fields")
    if not fields[index].isdecimal() or len(fields[index]) > _LONGEST_COUNT:
        raise _MalformedError(f"has {quoted(fields[index])} where a number of readings belongs")
    return int(fields[index])


def _expect(fields: list[str], number: int, what: str) -> None:
    if len(fields) != number:
        raise _MalformedError(f"{what} must have {number} fields, but has {len(fields)}")


def _numbers(fields: list[str]) -> list[float]:
    try:
        values = [plain_number(field) for field in fields]
    except ValueError:
        raise _MalformedError(f"has a field that is no number: {quoted(' '.join(fields))}") from None
    if not all(map(math.isfinite, values)):
        raise _MalformedError(f"has a time, pose or angle that is not finite: {quoted(' '.join(fields))}")
    return values


def _ranges(fields: list[str]) -> NDArray[np.float32]:
    try:
        with np.errstate(over="ignore"):  # a reading of 1e300 m is as good as an infinite one
            return np.array([plain_number(field) for field in fields], dtype=np.float32)
    except ValueError as error:
        raise _MalformedError(f"has a reading that is no number ({error})") from None


def _mount(path: Path, readings: list[_Reading]) -> tuple[Pose, list[str]]:
    """T_base_sensor and notes: of the first scan, which must hold for all; else of most, which must nearly do.

    A robot's and a laser's pose that were taken at different times disagree while it moves, around the true mount.
    """
    mounts = between([reading.scan.odometry for reading in readings], [reading.laser for reading in readings])
    shifts, turns = _apart(mounts, mounts[0])
    if float(shifts.max()) <= _MOUNT_TOLERANCE[0] and float(turns.max()) <= _MOUNT_TOLERANCE[1]:
        x, y, theta = mounts[0].tolist()
        return (x, y, theta), []
    angle = float(np.angle(np.mean(np.exp(1j * mounts[:, 2]))))
    usual = np.array([*np.median(mounts[:, :2], axis=0), angle + np.median(wrap_angle(mounts[:, 2] - angle))])
    off = _apart(mounts, usual)
    if np.mean((off[0] > _MOUNT_JITTER[0]) | (off[1] > _MOUNT_JITTER[1])) > _MOUNT_OUTLIERS:
        raise InputError(
            f"{path}: the laser does not stay in its place on the robot: its pose against the robot's changes by "
            f"{shifts.max():.2f} m and {math.degrees(turns.max()):.1f} degrees. Its poses may be another program's "
            "corrected ones: use the raw log, or say where the laser sits with mount (--mount X Y THETA)"
        )
    x, y, theta = usual.tolist()
    return (x, y, theta), [
        f"the laser's pose against the robot's changes by up to {shifts.max():.2f} m and "
        f"{math.degrees(turns.max()):.1f} degrees, as where the two were taken at different times: it is taken to sit "
        f"at ({x:z.3f}, {y:z.3f}, {math.degrees(theta):z.1f} deg) as in most scans"
    ]


def _apart(mounts: NDArray[np.float64], mount: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How far [m] and how much turned [rad] each is from one."""
    changes = between(mount, mounts)
    return np.hypot(changes[:, 0], changes[:, 1]), np.abs(changes[:, 2])


def _why_without_odometry(scans: list[Scan], use_odometry: bool) -> str:
    if not use_odometry:
        return "use_odometry is off (--no-odometry)"
    samples = np.array([(scan.time, *scan.odometry) for scan in scans])
    return "the log has the same robot pose in every scan" if is_parked(samples) else ""


def _limited(scans: list[Scan], limits: ScanLimits) -> tuple[list[Scan], list[str]]:
    """The scans within limits, where a value that means no return counts as one, and notes."""
    sample = scans[:: len(scans) // _SAMPLE + 1]
    within = [scan.ranges[scan.ranges < limits.range_max(scan.range_max)] for scan in sample]
    beams = sum(len(scan.ranges) for scan in sample)
    no_return, notes = find_no_return(within, beams)
    return [
        replace(
            scan,
            range_min=limits.range_min(scan.range_min),
            range_max=min(limits.range_max(scan.range_max), no_return),
            ranges=limits.usable(scan.ranges, scan.angle_min, scan.angle_increment),
        )
        for scan in scans
    ], notes


def _notes(scans: list[Scan], others: Counter[str]) -> list[str]:
    notes = []
    if others:
        listed = ", ".join(f"{count} {keyword[:20]}" for keyword, count in others.most_common(6))
        notes.append(f"ignored lines: {listed}")
    backwards = int(np.count_nonzero(np.diff([scan.time for scan in scans]) < 0.0))
    if backwards:
        notes.append(f"the stamps go backwards {backwards} times; the order of the lines is kept")
    return notes
