# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Reads ROS 1 and ROS 2 bags: laser scans, with odometry from tf or nav_msgs/Odometry."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.highlevel import AnyReader
from rosbags.interfaces import Connection

from oort._core import Parameters
from oort.errors import InputError
from oort.recording.container import Container
from oort.recording.frames import FrameTree
from oort.recording.gyro import GyroRecord
from oort.recording.laser_scan import scan_from_message, seconds
from oort.recording.limits import ScanLimits
from oort.recording.motion import SNAPSHOT, Placement, beam_span
from oort.recording.rig import Rig, Survey, assemble
from oort.recording.scan_fields import Correction, ScanFields, angle_increment
from oort.recording.types import Pose, Recording, Scan

_SCAN = "sensor_msgs/msg/LaserScan"
_ECHOES = "sensor_msgs/msg/MultiEchoLaserScan"
_ODOMETRY = "nav_msgs/msg/Odometry"
_IMU = "sensor_msgs/msg/Imu"
_CLOUD = "sensor_msgs/msg/PointCloud2"
_TF = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")


def read_bag(
    container: Container,
    *,
    name: str,
    scan_topics: Sequence[str],
    scan_frame: str | None,
    odom_frame: str | None,
    imu_topic: str | None,
    mount: Pose | None,
    limits: ScanLimits,
    parameters: Parameters,
) -> Recording:
    """Looks through a bag; its scans are read again when they are asked for.

    The base is the child of the odometry frame. A scan outside the odometry's time span or without readings is
    skipped and counted in the notes. See `open_recording` for the parameters and errors.
    """
    path = container.path
    with container.opened() as reader:
        wanted: Sequence[str | None] = scan_topics or [None]
        topics = [
            _choose(
                path, reader, (_SCAN, _ECHOES), topic, "laser scans", "scan_topic (--scan-topic, once for each laser)"
            )
            for topic in wanted
        ]
        imu = ""
        if imu_topic is not None or parameters.get("use_imu"):
            imu = _choose(path, reader, (_IMU,), imu_topic, "IMU messages", "imu_topic (--imu-topic)")
        fields = {topic: ScanFields(topic) for topic in topics}
        survey = Survey(fields, scan_frame, compensates=bool(parameters.get("motion_compensation")))
        survey.gyro = GyroRecord(imu) if imu else None
        _read(reader, survey)
    try:
        rig = assemble(survey, odom_frame, mount, parameters)
        settled = {topic: fields.settle(limits) for topic, fields in survey.fields.items() if fields.num_scans}
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    corrections = {topic: correction for topic, (correction, _) in settled.items()}
    told = [note for _, notes in settled.values() for note in notes]
    scans = zip(survey.scan_times, survey.scan_spans, strict=True)
    usable = [rig.place(time, span) is not None for time, span in scans]
    if not any(usable):
        raise InputError(f"{path}: {_why_unusable(survey)}")
    return Recording(
        name=name,
        kind=container.kind,
        sensor_on_base=rig.sensor_on_base,
        num_scans=sum(usable),
        notes=(*container.notes, *rig.notes, *told, *_skip_notes(survey, usable)),
        source=lambda: _scans(container, survey, rig, corrections, limits),
        without_odometry=rig.without_odometry,
    )


def _choose(path: Path, reader: AnyReader, kinds: tuple[str, ...], wanted: str | None, what: str, option: str) -> str:
    """The topic with messages of one of these kinds. Raises InputError if it is missing or there are several."""
    topics = sorted({connection.topic for connection in reader.connections if connection.msgtype in kinds})
    if wanted is not None:
        for topic in topics:
            if topic.strip("/") == wanted.strip("/"):
                return topic
        known = f"there are {what.split()[-1]} on: {', '.join(topics) or 'no topic'}"
        raise InputError(f"{path}: no {what} on {wanted}; {known}")
    if not topics:
        types = {connection.msgtype for connection in reader.connections}
        advice = "; use_imu asks for one: set use_imu to false, or record an IMU" if _IMU in kinds else ""
        if _SCAN in kinds and _CLOUD in types:
            advice = "; of a PointCloud2 ROS's pointcloud_to_laserscan makes a LaserScan: record that"
        others = sorted({f"{connection.topic} ({connection.msgtype})" for connection in reader.connections})
        raise InputError(
            f"{path}: no topic of type {kinds[0]}; the bag has: {', '.join(others[:20]) or 'nothing'}{advice}"
        )
    if len(topics) > 1:
        raise InputError(f"{path}: several topics with {what}; choose one with {option}: {', '.join(topics)}")
    return topics[0]


def _read(reader: AnyReader, survey: Survey) -> None:
    """The first pass: all that says how scans and odometry go together."""
    topics = {*survey.fields, *([] if survey.gyro is None else [survey.gyro.topic])}
    wanted = [c for c in reader.connections if c.topic in topics or c.msgtype in (_ODOMETRY, *_TF)]
    count = 0
    for connection, _, raw in reader.messages(wanted):
        count += 1
        message = _read_message(reader, connection, raw)
        if connection.topic in survey.fields:
            _note_scan(survey, connection.topic, message)
        elif survey.gyro is not None and connection.topic == survey.gyro.topic:
            survey.gyro.add(_frame(message.header.frame_id), _seconds(message.header.stamp), message)
        elif connection.msgtype == _ODOMETRY:
            frames = (_frame(message.header.frame_id), _frame(message.child_frame_id))
            tree = survey.odometry.setdefault((connection.topic, *frames), FrameTree())
            pose = message.pose.pose
            _add(tree, *frames, message.header.stamp, pose.position, pose.orientation, connection.topic)
        else:
            for item in message.transforms:
                frames = (_frame(item.header.frame_id), _frame(item.child_frame_id))
                pose = item.transform
                _add(survey.tf, *frames, item.header.stamp, pose.translation, pose.rotation, connection.topic)
    expected = sum(connection.msgcount for connection in wanted)
    if count < expected:
        raise InputError(f"{reader.paths[0]}: holds {count} of the {expected} messages that it lists; copy it again")


def _read_message(reader: AnyReader, connection: Connection, raw: bytes) -> Any:
    """A message; one with several echoes of each beam as the LaserScan of its first ones."""
    message: Any = reader.deserialize(raw, connection.msgtype)
    if connection.msgtype != _ECHOES:
        return message
    first = np.array([beam.echoes[0] if len(beam.echoes) else np.inf for beam in message.ranges], dtype=np.float32)
    return replace(message, ranges=first)


def _note_scan(survey: Survey, topic: str, message: Any) -> None:
    frame = _frame(message.header.frame_id)
    survey.scan_frames[frame] = None
    if not survey.is_wanted(frame):
        survey.other_scans += 1
    elif len(message.ranges):
        survey.fields[topic].add(message)
        survey.scan_times.append(_seconds(message.header.stamp))
        span = beam_span(len(message.ranges), message.time_increment) if survey.compensates else SNAPSHOT
        survey.scan_spans.append(span or SNAPSHOT)
        survey.impossible_spans += span is None
    else:
        survey.empty_scans += 1


def _add(tree: FrameTree, parent: str, child: str, stamp: Any, translation: Any, rotation: Any, topic: str) -> None:
    tree.add(
        parent,
        child,
        _seconds(stamp),
        (translation.x, translation.y, translation.z),
        (rotation.x, rotation.y, rotation.z, rotation.w),
        topic,
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
        f"not in frame {survey.scan_frame}": survey.other_scans,
    }
    return [f"scans skipped, {why}: {count}" for why, count in skipped.items() if count]


def _scans(
    container: Container, survey: Survey, rig: Rig, corrections: Mapping[str, Correction], limits: ScanLimits
) -> Iterator[Scan]:
    """The second pass: the usable scans in the order of the recording."""
    spans = iter(survey.scan_spans)
    with container.opened() as reader:
        wanted = [connection for connection in reader.connections if connection.topic in survey.fields]
        for connection, _, raw in reader.messages(wanted):
            message = _read_message(reader, connection, raw)
            frame = _frame(message.header.frame_id)
            if not len(message.ranges) or not survey.is_wanted(frame):
                continue
            placement = rig.place(_seconds(message.header.stamp), next(spans))
            if placement is not None:
                yield _to_scan(message, placement, rig, corrections[connection.topic], limits)


def _to_scan(message: Any, placement: Placement, rig: Rig, correction: Correction, limits: ScanLimits) -> Scan:
    mount, upside_down = rig.lasers[_frame(message.header.frame_id)]
    return scan_from_message(
        whole_seconds=message.header.stamp.sec,
        nanoseconds=message.header.stamp.nanosec,
        angle_min=message.angle_min,
        angle_increment=angle_increment(message),
        range_min=message.range_min,
        range_max=correction.range_max(message.range_max),
        ranges=message.ranges,
        placement=placement,
        upside_down=upside_down,
        limits=limits,
        mount=None if mount == rig.sensor_on_base else mount,
    )
