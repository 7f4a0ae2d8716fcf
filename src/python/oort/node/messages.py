# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Between Oort's values and ROS messages. Poses are x [m], y [m], theta [rad]."""

import io
import math
import struct
from typing import BinaryIO

import genpy
import numpy as np
from geometry_msgs.msg import PoseStamped, Quaternion, TransformStamped
from nav_msgs.msg import OccupancyGrid
from oort_msgs.srv import GetMapResponse
from sensor_msgs.msg import LaserScan

from oort import _core
from oort.errors import InputError
from oort.recording import Pose, Scan
from oort.recording.frames import heading, unit_quaternion
from oort.recording.laser_scan import scan_from_message
from oort.recording.limits import NO_LIMITS, ScanLimits
from oort.recording.motion import Placement


class FastGrid(OccupancyGrid):  # type: ignore[misc]
    """An OccupancyGrid whose `data` is an int8 array: the same bytes, written at once instead of cell by cell."""

    def serialize(self, buff: BinaryIO) -> None:
        """Writes the message; `data` that is not an int8 array goes the generated way, with its checks."""
        if getattr(self.data, "dtype", None) != np.int8:
            super().serialize(buff)
            return
        head = io.BytesIO()
        OccupancyGrid(self.header, self.info, []).serialize(head)  # ends in the count of cells, 0
        buff.write(head.getbuffer()[:-4])
        buff.write(struct.pack("<I", self.data.size))
        buff.write(self.data.tobytes())


class FastMapResponse(GetMapResponse):  # type: ignore[misc]
    """A GetMapResponse that lets its map write itself; rospy tells responses by their `_type`, so it takes this one."""

    def serialize(self, buff: BinaryIO) -> None:
        """Writes the message."""
        self.map.serialize(buff)


def grid_message(grid: _core.OccupancyGrid, frame: str, stamp: genpy.Time) -> FastGrid:
    """A rendered map as a message, its rows along the x axis of `frame`."""
    message = FastGrid()
    message.header.frame_id, message.header.stamp = frame, stamp
    message.info.map_load_time = stamp
    message.info.resolution, message.info.width, message.info.height = grid.resolution, grid.width, grid.height
    message.info.origin.position.x, message.info.origin.position.y = grid.origin
    message.info.origin.orientation.w = 1.0
    message.data = grid.cells.reshape(-1)
    return message


def map_reply(message: FastGrid) -> FastMapResponse:
    """The answer of the service map/map."""
    return FastMapResponse(map=message)


def pose_stamped(pose: Pose, frame: str, stamp: genpy.Time) -> PoseStamped:
    """A pose in a frame."""
    message = PoseStamped()
    message.header.frame_id, message.header.stamp = frame, stamp
    message.pose.position.x, message.pose.position.y, theta = pose
    message.pose.orientation = rotation(theta)
    return message


def transform(parent: str, child: str, stamp: genpy.Time, pose: Pose) -> TransformStamped:
    """T_parent_child as a transform for tf."""
    message = TransformStamped()
    message.header.frame_id, message.header.stamp, message.child_frame_id = parent, stamp, child
    message.transform.translation.x, message.transform.translation.y, theta = pose
    message.transform.rotation = rotation(theta)
    return message


def rotation(theta: float) -> Quaternion:
    """A turn about z."""
    return Quaternion(0.0, 0.0, math.sin(0.5 * theta), math.cos(0.5 * theta))


def yaw(quaternion: Quaternion) -> float:
    """The turn about z [rad] of a quaternion of any length but zero, else InputError."""
    unit = unit_quaternion(quaternion.x, quaternion.y, quaternion.z, quaternion.w)
    if unit is None:
        q = quaternion
        raise InputError(f"({q.x}, {q.y}, {q.z}, {q.w}) is not a rotation; w = 1 and the rest 0 is no turn")
    return heading(*unit)


def to_scan(message: LaserScan, placement: Placement, upside_down: bool, limits: ScanLimits = NO_LIMITS) -> Scan:
    """A scan with its odometry: the very bits that reading the message from a bag would give."""
    return scan_from_message(
        whole_seconds=message.header.stamp.secs,
        nanoseconds=message.header.stamp.nsecs,
        angle_min=message.angle_min,
        angle_increment=message.angle_increment,
        range_min=message.range_min,
        range_max=message.range_max,
        ranges=message.ranges,
        placement=placement,
        upside_down=upside_down,
        limits=limits,
    )
