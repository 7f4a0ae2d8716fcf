# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The gyro of an IMU: its yaw rates on the base, and odometry that turns by them."""

import math
from array import array
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort._core import GyroOdometry
from oort.errors import InputError
from oort.recording.frames import FrameTree, Link

Vector = tuple[float, float, float]
"""x, y, z."""

LEVEL: Vector = (0.0, 0.0, 1.0)
"""The base's upward axis in the frame of an IMU that sits level on it."""

_AHEAD = 1.0  # [s]; rates that are this much later than all odometry have a wrong stamp, or are of no use


def angular_velocity(message: Any) -> Vector | None:
    """What a sensor_msgs/Imu tells [rad/s] along its own axes; None if it tells nothing or no numbers."""
    rate = message.angular_velocity
    told = message.angular_velocity_covariance[0] != -1.0  # how the message says that there is none
    values = float(rate.x), float(rate.y), float(rate.z)
    return values if told and all(map(math.isfinite, values)) else None


def upward(tree: FrameTree, base: str, frame: str) -> Vector | None:
    """The base's upward axis in the IMU's frame, so that its product with an angular velocity is the yaw rate.

    None if no transform leads there. Raises InputError if the IMU is not fixed on the base.
    """
    if frame == base:
        return LEVEL
    try:
        tree.ways(base, frame)
    except InputError:
        return None
    x, y, z = tree.mount(base, frame, "IMU")[2, :3].tolist()
    return x, y, z


def yaw_rate(rate: Vector, axis: Vector) -> float:
    """The part of an angular velocity [rad/s] that is about an axis."""
    return rate[0] * axis[0] + rate[1] * axis[1] + rate[2] * axis[2]


class GyroRecord:
    """What a recording's IMU tells."""

    def __init__(self, topic: str) -> None:
        """Nothing so far."""
        self.topic = topic
        self.frames: dict[str, None] = {}
        self.unusable = 0
        self._samples = array("d")

    def add(self, frame: str, time: float, message: Any) -> None:
        """Adds a sensor_msgs/Imu with the time of its stamp [s]."""
        self.frames[frame] = None
        rate = angular_velocity(message)
        if rate is None:
            self.unusable += 1
        else:
            self._samples.extend((time, *rate))

    def samples(self) -> NDArray[np.float64]:
        """(n, 4) time [s] and angular velocity [rad/s] along the IMU's axes, in the order of the recording."""
        return np.frombuffer(self._samples, dtype=np.float64).reshape(-1, 4)


def turned_by_gyro(
    record: GyroRecord, tree: FrameTree, base: str, link: Link
) -> tuple[list[tuple[float, float, float, float]], list[str]]:
    """The poses (time, x, y, theta) of a link with the gyro's turns, and notes.

    Raises InputError if the IMU tells nothing, or is in several frames or not fixed on the base.
    """
    rates = record.samples()
    if not len(rates):
        raise InputError(f"no yaw rate on {record.topic} ({record.unusable} messages without numbers)")
    if len(record.frames) > 1:
        raise InputError(f"the IMU on {record.topic} is in several frames: {', '.join(record.frames)}")
    notes = [f"turns are those of the gyro on {record.topic}"]
    frame = next(iter(record.frames))
    axis = upward(tree, base, frame)
    if axis is None:
        notes.append(f"no transform leads from {base} to the IMU's frame {frame!r}: it is taken to sit level")
    odometry = GyroOdometry()
    samples = np.frombuffer(link.samples, dtype=np.float64).reshape(-1, 4)
    told, end = samples.tolist(), samples[:, 0].max() + _AHEAD
    turns = [(time, yaw_rate((x, y, z), axis or LEVEL)) for time, x, y, z in rates[rates[:, 0] < end].tolist()]
    number = 0
    for time, x, y, theta in told:
        while number < len(turns) and turns[number][0] <= time:
            odometry.add_gyro(*turns[number])
            number += 1
        odometry.add_odometry(time, x, y, theta)
    for turn in turns[number:]:
        odometry.add_gyro(*turn)
    odometry.flush()
    poses = odometry.take()
    if len(poses) < len(told):
        notes.append(f"{len(told) - len(poses)} poses of odometry are not newer than the one before and were left out")
    return poses, notes + _notes(record, odometry)


def _notes(record: GyroRecord, odometry: GyroOdometry) -> list[str]:
    notes = []
    if record.unusable:
        notes.append(f"{record.unusable} messages on {record.topic} tell no numbers and were ignored")
    if odometry.bias is None:
        notes.append("the base never stood still, so the gyro's bias is not known: odometry's own turns are used")
    else:
        steps = odometry.steps_by_gyro + odometry.steps_by_odometry
        notes.append(
            f"the gyro's bias is {math.degrees(odometry.bias):.3f} degrees/s at the end; it turned "
            f"{odometry.steps_by_gyro} of {steps} steps of odometry"
        )
    return notes
