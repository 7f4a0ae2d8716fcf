# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A drive through a made-up hall: walls 40 m apart, racks, and a laser whose beams are 0.1 m to 1 m apart out there."""

import math
from functools import cache

import numpy as np

from oort.poses import Array, compose
from oort.recording import Pose, Scan
from oort.simulate import Sensor
from oort.simulate.sensor import cast, measure

MOUNT: Pose = (0.3, 0.0, 0.0)
_SENSOR = Sensor(field_of_view=math.radians(181.0), beams=181, range_max=20.0, noise=0.01, noise_per_metre=0.0)
_PERIOD = 0.1  # [s] between scans


def _box(x: float, y: float, length: float, width: float) -> list[list[float]]:
    corners = [(x, y), (x + length, y), (x + length, y + width), (x, y + width)]
    return [[*a, *b] for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]


def _segments() -> Array:
    pillars = [_box(x, y, 0.5, 0.5) for x in (-8.0, 0.0, 8.0, 16.0) for y in (-9.0, 8.5)]
    racks = [_box(2.0, -1.5, 5.0, 1.2), _box(9.0, -1.5, 5.0, 1.2), _box(3.0, 1.3, 9.0, 1.2), _box(-6.0, -1.0, 2.0, 3.0)]
    return np.array([line for box in [_box(-15.0, -12.0, 40.0, 24.0), *pillars, *racks] for line in box])


def _path() -> Array:
    """The base (n, 3): round the racks, with bends of 1 m."""
    poses = [np.array([0.0, -4.0, 0.0])]
    for metres in (15.0, 6.0, 15.0, 6.0):
        straight = [(1.2 * _PERIOD, 0.0, 0.0)] * round(metres / (1.2 * _PERIOD))
        bend = [(0.06, 0.0, math.pi / 2.0 / 26)] * 26
        for step in straight + bend:
            poses.append(compose(poses[-1], np.array(step)))
    return np.array(poses)


@cache
def hall_drive() -> tuple[Scan, ...]:
    """The scans, with perfect odometry."""
    poses, segments = _path(), _segments()
    seen = [
        cast(segments, np.empty((0, 3)), pose[:2], pose[2] + _SENSOR.angles, _SENSOR.range_max)
        for pose in compose(poses, np.array(MOUNT))
    ]
    true, incidence = (np.stack(columns) for columns in zip(*seen, strict=True))
    ranges = measure(_SENSOR, true, incidence, np.random.default_rng(1))
    limits = _SENSOR.angle_min, _SENSOR.angle_increment, _SENSOR.range_min, _SENSOR.range_max
    return tuple(
        Scan(row, *limits, _PERIOD * k, stamp=f"{_PERIOD * k:.6f}", odometry=(x, y, theta))
        for k, (row, (x, y, theta)) in enumerate(zip(ranges, poses.tolist(), strict=True))
    )
