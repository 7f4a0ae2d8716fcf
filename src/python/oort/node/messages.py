# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Between Oort's values and ROS messages, of either ROS. Poses are x [m], y [m], theta [rad]."""

import math
from typing import Any

import numpy as np
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, Quaternion, TransformStamped
from numpy.typing import NDArray
from sensor_msgs.msg import LaserScan

from oort import _core
from oort.errors import InputError
from oort.recording import Pose, Scan
from oort.recording.frames import heading, unit_quaternion
from oort.recording.laser_scan import scan_from_message
from oort.recording.limits import NO_LIMITS, ScanLimits
from oort.recording.motion import Placement


def stamp_parts(stamp: Any) -> tuple[int, int]:
    """Whole seconds and nanoseconds of a message's stamp, which ROS 1 and ROS 2 name differently."""
    return (stamp.sec, stamp.nanosec) if hasattr(stamp, "nanosec") else (stamp.secs, stamp.nsecs)


def nanoseconds(stamp: str) -> int:
    """[ns] of a scan's stamp, to the last digit: what a subscriber matches with the scan."""
    whole, _, part = stamp.partition(".")
    return int(whole) * 1_000_000_000 + int(f"{part:0<9}")


def place_grid(message: Any, grid: _core.OccupancyGrid, frame: str, stamp: Any) -> Any:
    """The message with the cells of a rendered map, completed: its rows lie along the x axis of `frame`."""
    message.header.frame_id, message.header.stamp = frame, stamp
    message.info.map_load_time = stamp
    message.info.resolution = float(grid.resolution)
    message.info.width, message.info.height = int(grid.width), int(grid.height)
    message.info.origin.position.x, message.info.origin.position.y = map(float, grid.origin)
    message.info.origin.orientation.w = 1.0
    return message


def pose_stamped(pose: Pose, frame: str, stamp: Any) -> PoseStamped:
    """A pose in a frame."""
    message = PoseStamped()
    message.header.frame_id, message.header.stamp = frame, stamp
    x, y, theta = map(float, pose)
    message.pose.position.x, message.pose.position.y = x, y
    message.pose.orientation = rotation(theta)
    return message


def pose_with_covariance(
    pose: Pose, covariance: NDArray[np.float64], frame: str, stamp: Any
) -> PoseWithCovarianceStamped:
    """A pose in a frame with its covariance (3, 3) along the axes of that frame."""
    message = PoseWithCovarianceStamped()
    message.header.frame_id, message.header.stamp = frame, stamp
    x, y, theta = map(float, pose)
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    message.pose.pose.orientation = rotation(theta)
    full = np.zeros((6, 6))
    full[np.ix_([0, 1, 5], [0, 1, 5])] = covariance
    message.pose.covariance = full.ravel().tolist()
    return message


def transform(parent: str, child: str, stamp: Any, pose: Pose) -> TransformStamped:
    """T_parent_child as a transform for tf."""
    message = TransformStamped()
    message.header.frame_id, message.header.stamp, message.child_frame_id = parent, stamp, child
    x, y, theta = map(float, pose)
    message.transform.translation.x, message.transform.translation.y = x, y
    message.transform.rotation = rotation(theta)
    return message


def rotation(theta: float) -> Quaternion:
    """A turn about z."""
    return Quaternion(x=0.0, y=0.0, z=math.sin(0.5 * theta), w=math.cos(0.5 * theta))


def yaw(quaternion: Quaternion) -> float:
    """The turn about z [rad] of a quaternion of any length but zero, else InputError."""
    unit = unit_quaternion(quaternion.x, quaternion.y, quaternion.z, quaternion.w)
    if unit is None:
        q = quaternion
        raise InputError(f"({q.x}, {q.y}, {q.z}, {q.w}) is not a rotation; w = 1 and the rest 0 is no turn")
    return heading(*unit)


def to_scan(
    message: LaserScan,
    placement: Placement,
    upside_down: bool,
    limits: ScanLimits = NO_LIMITS,
    mount: Pose | None = None,
) -> Scan:
    """A scan with its odometry: the very bits that reading the message from a bag would give."""
    whole_seconds, nanoseconds = stamp_parts(message.header.stamp)
    return scan_from_message(
        whole_seconds=whole_seconds,
        nanoseconds=nanoseconds,
        angle_min=message.angle_min,
        angle_increment=message.angle_increment,
        range_min=message.range_min,
        range_max=message.range_max,
        ranges=message.ranges,
        placement=placement,
        upside_down=upside_down,
        limits=limits,
        mount=mount,
    )
