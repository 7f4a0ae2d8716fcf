# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Reads ROS 1 and ROS 2 bags: laser scans, with odometry from tf or nav_msgs/Odometry."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from oort._core import Parameters
from oort.errors import InputError, OortError
from oort.recording.frames import FrameTree
from oort.recording.gyro import GyroRecord
from oort.recording.laser_scan import scan_from_message, seconds
from oort.recording.motion import SNAPSHOT, Placement, beam_span
from oort.recording.rig import Rig, Survey, assemble
from oort.recording.types import Recording, Scan

_SCAN = "sensor_msgs/msg/LaserScan"
_ODOMETRY = "nav_msgs/msg/Odometry"
_IMU = "sensor_msgs/msg/Imu"
_TF = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")


def read_bag(
    path: Path,
    *,
    name: str,
    kind: str,
    scan_topic: str | None,
    odom_frame: str | None,
    imu_topic: str | None,
    max_range: float | None,
    parameters: Parameters,
) -> Recording:
    """Looks through a bag; its scans are read again when they are asked for.

    The base is the child of the odometry frame. A scan outside the odometry's time span or without readings is
    skipped and counted in the notes. See `open_recording` for the parameters and errors.
    """
    for database in sorted(path.glob("*.db3")) if path.is_dir() else [path]:
        _check_database_size(database)
    with _opened(path) as reader:
        topic = _choose(path, reader, _SCAN, scan_topic, "laser scans", "scan_topic (--scan-topic)")
        imu = ""
        if imu_topic is not None or parameters.get("use_imu"):
            imu = _choose(path, reader, _IMU, imu_topic, "IMU messages", "imu_topic (--imu-topic)")
        survey = _survey(reader, topic, imu, bool(parameters.get("motion_compensation")))
    try:
        rig = assemble(survey, odom_frame, parameters)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    scans = zip(survey.scan_times, survey.scan_spans, strict=True)
    usable = [rig.place(time, span) is not None for time, span in scans]
    if not any(usable):
        raise InputError(f"{path}: {_why_unusable(survey)}")
    limit = math.inf if max_range is None else max_range
    return Recording(
        name=name,
        kind=kind,
        sensor_on_base=rig.sensor_on_base,
        num_scans=sum(usable),
        notes=(*rig.notes, *_skip_notes(survey, usable)),
        source=lambda: _scans(path, survey, rig, limit),
    )


def _check_database_size(path: Path) -> None:
    """Refuses a cut SQLite file: SQLite itself would read zeros for the missing part of the last page."""
    with path.open("rb") as stream:
        header = stream.read(100)
    if not header.startswith(b"SQLite format 3\0") or len(header) < 100:
        return
    page_size = int.from_bytes(header[16:18], "big")
    pages = int.from_bytes(header[28:32], "big")
    expected = (65536 if page_size == 1 else page_size) * pages
    if header[24:28] == header[92:96] and path.stat().st_size < expected:  # else the count of pages is not kept
        raise InputError(f"{path} is cut short: it has {path.stat().st_size} of {expected} bytes; copy it again")


@contextmanager
def _opened(path: Path) -> Iterator[AnyReader]:
    """A reader of the bag; whatever goes wrong in reading a damaged one becomes an InputError."""
    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.LATEST)) as reader:
            yield reader
    except OortError:
        raise
    except Exception as error:  # the bag library's errors have no common root, and damage shows in many ways
        raise InputError(
            f"{path} cannot be read ({type(error).__name__}: {error}): it is damaged or cut short. Copy it again; a "
            "recording that was not ended properly can be repaired with 'rosbag reindex' or 'ros2 bag reindex'"
        ) from error


def _choose(path: Path, reader: AnyReader, kind: str, wanted: str | None, what: str, option: str) -> str:
    """The topic with messages of a kind. Raises InputError if it is missing or there are several."""
    topics = sorted({connection.topic for connection in reader.connections if connection.msgtype == kind})
    if wanted is not None:
        for topic in topics:
            if topic.strip("/") == wanted.strip("/"):
                return topic
        known = f"there are {what.split()[-1]} on: {', '.join(topics) or 'no topic'}"
        raise InputError(f"{path}: no {what} on {wanted}; {known}")
    if not topics:
        advice = "; use_imu asks for one: set use_imu to false, or record an IMU" if kind == _IMU else ""
        others = sorted({f"{connection.topic} ({connection.msgtype})" for connection in reader.connections})
        raise InputError(f"{path}: no topic of type {kind}; the bag has: {', '.join(others[:20]) or 'nothing'}{advice}")
    if len(topics) > 1:
        raise InputError(f"{path}: several topics with {what}; choose one with {option}: {', '.join(topics)}")
    return topics[0]


def _survey(reader: AnyReader, scan_topic: str, imu_topic: str, compensates: bool) -> Survey:
    survey = Survey(scan_topic)
    survey.gyro = GyroRecord(imu_topic) if imu_topic else None
    wanted = [c for c in reader.connections if c.topic in (scan_topic, imu_topic) or c.msgtype in (_ODOMETRY, *_TF)]
    count = 0
    for connection, _, raw in reader.messages(wanted):
        count += 1
        message: Any = reader.deserialize(raw, connection.msgtype)
        if connection.topic == scan_topic:
            survey.scan_frames[_frame(message.header.frame_id)] = None
            if len(message.ranges):
                survey.scan_times.append(_seconds(message.header.stamp))
                span = beam_span(len(message.ranges), message.time_increment) if compensates else SNAPSHOT
                survey.scan_spans.append(span or SNAPSHOT)
                survey.impossible_spans += span is None
            else:
                survey.empty_scans += 1
        elif survey.gyro is not None and connection.topic == imu_topic:
            survey.gyro.add(_frame(message.header.frame_id), _seconds(message.header.stamp), message)
        elif connection.msgtype == _ODOMETRY:
            frames = (_frame(message.header.frame_id), _frame(message.child_frame_id))
            tree = survey.odometry.setdefault((connection.topic, *frames), FrameTree())
            pose = message.pose.pose
            _add(tree, *frames, message.header.stamp, pose.position, pose.orientation)
        else:
            for item in message.transforms:
                frames = (_frame(item.header.frame_id), _frame(item.child_frame_id))
                _add(survey.tf, *frames, item.header.stamp, item.transform.translation, item.transform.rotation)
    expected = sum(connection.msgcount for connection in wanted)
    if count < expected:
        raise InputError(f"{reader.paths[0]}: holds {count} of the {expected} messages that it lists; copy it again")
    return survey


def _add(tree: FrameTree, parent: str, child: str, stamp: Any, translation: Any, rotation: Any) -> None:
    tree.add(
        parent,
        child,
        _seconds(stamp),
        (translation.x, translation.y, translation.z),
        (rotation.x, rotation.y, rotation.z, rotation.w),
    )


def _frame(name: str) -> str:
    return name.lstrip("/")  # ROS 1's old tf wrote frames with a slash


def _seconds(stamp: Any) -> float:
    return seconds(stamp.sec, stamp.nanosec)


def _why_unusable(survey: Survey) -> str:
    return (
        f"no scan on {survey.scan_topic} lies within the odometry's time span (scans from {min(survey.scan_times):.3f} "
        f"to {max(survey.scan_times):.3f} s); check that both were stamped by the same clock"
    )


def _skip_notes(survey: Survey, usable: list[bool]) -> list[str]:
    first = usable.index(True)
    end = len(usable) - usable[::-1].index(True)
    skipped = {
        "before the first odometry": first,
        "after the last odometry": len(usable) - end,
        "outside the odometry's time span": usable[first:end].count(False),
        "without readings": survey.empty_scans,
    }
    return [f"scans skipped, {why}: {count}" for why, count in skipped.items() if count]


def _scans(path: Path, survey: Survey, rig: Rig, max_range: float) -> Iterator[Scan]:
    """The second pass: the usable scans in the order of the recording."""
    spans = iter(survey.scan_spans)
    with _opened(path) as reader:
        wanted = [connection for connection in reader.connections if connection.topic == survey.scan_topic]
        for connection, _, raw in reader.messages(wanted):
            message: Any = reader.deserialize(raw, connection.msgtype)
            if not len(message.ranges):
                continue
            placement = rig.place(_seconds(message.header.stamp), next(spans))
            if placement is not None:
                yield _to_scan(message, placement, rig.upside_down, max_range)


def _to_scan(message: Any, placement: Placement, upside_down: bool, max_range: float) -> Scan:
    return scan_from_message(
        whole_seconds=message.header.stamp.sec,
        nanoseconds=message.header.stamp.nanosec,
        angle_min=message.angle_min,
        angle_increment=message.angle_increment,
        range_min=message.range_min,
        range_max=min(float(message.range_max), max_range),
        ranges=message.ranges,
        placement=placement,
        upside_down=upside_down,
    )
