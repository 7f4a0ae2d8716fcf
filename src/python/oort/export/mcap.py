# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The solved drive as an MCAP of ROS 2 messages, to play in Foxglove or with ros2 bag play."""

import os
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from oort._core import Map, OccupancyGrid
from oort.errors import InputError, OortError
from oort.recording.types import Pose

_MAP, _SENSOR = "map", "laser"  # frames
_END_OF_TIME = float((1 << 31) - 1)  # [s] beyond which a message's int32 cannot count
_TOPICS = {
    "/map": "nav_msgs/msg/OccupancyGrid",
    "/trajectory": "nav_msgs/msg/Path",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/points": "sensor_msgs/msg/PointCloud2",
}


def write_mcap(path: Path, map_: Map, grid: OccupancyGrid) -> None:
    """Writes /map and /trajectory once, and at each node's stamp /tf (map to laser) and /points (its scan).

    Raises InputError if ROS has no such stamps, OortError if the file cannot be written.
    """
    first_time, last_time = float(map_.cloud_times.min()), float(map_.cloud_times.max())
    if not 0.0 <= first_time <= last_time < _END_OF_TIME:
        raise InputError(
            f"the nodes' stamps, {first_time:g} to {last_time:g} s, are none that a message of ROS can have: "
            "they count from 1970, to 2038"
        )
    store = get_typestore(Stores.ROS2_HUMBLE)
    messages = _Messages(store.types)
    stamps = np.round(1e9 * map_.cloud_times).astype(np.int64).tolist()
    poses = map_.node_poses
    try:
        with tempfile.TemporaryDirectory(dir=path.absolute().parent, prefix=".oort-") as folder:
            bag = Path(folder) / "bag"
            with Writer(bag, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
                topics = {name: writer.add_connection(name, kind, typestore=store) for name, kind in _TOPICS.items()}

                def write(topic: str, stamp: int, message: Any) -> None:
                    writer.write(topics[topic], stamp, store.serialize_cdr(message, _TOPICS[topic]))

                first = min(stamps)
                write("/map", first, messages.grid(first, grid))
                write("/trajectory", first, messages.path(first, stamps, poses.tolist()))
                for k in np.argsort(stamps, kind="stable").tolist():
                    write("/tf", stamps[k], messages.transform(stamps[k], poses[k].tolist()))
                    cloud = map_.cloud(k)
                    write("/points", stamps[k], messages.points(stamps[k], cloud[cloud[:, 2] == 1.0, :2]))
            (written,) = bag.glob("*.mcap")
            os.replace(written, path)
    except OSError as error:
        raise OortError(f"{path}: the MCAP cannot be written: {error.strerror}") from error


class _Messages:
    """Makes ROS 2 messages from a typestore's classes."""

    def __init__(self, types: Any) -> None:
        self._types = types

    def _make(self, kind: str, /, **fields: Any) -> Any:
        return self._types[kind](**fields)

    def _header(self, stamp: int, frame: str) -> Any:
        time = self._make("builtin_interfaces/msg/Time", sec=stamp // 10**9, nanosec=stamp % 10**9)
        return self._make("std_msgs/msg/Header", stamp=time, frame_id=frame)

    def _rotation(self, theta: float) -> Any:
        z, w = float(np.sin(0.5 * theta)), float(np.cos(0.5 * theta))
        return self._make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=z, w=w)

    def _pose(self, pose: Pose) -> Any:
        point = self._make("geometry_msgs/msg/Point", x=pose[0], y=pose[1], z=0.0)
        return self._make("geometry_msgs/msg/Pose", position=point, orientation=self._rotation(pose[2]))

    def grid(self, stamp: int, grid: OccupancyGrid) -> Any:
        """nav_msgs/OccupancyGrid."""
        header = self._header(stamp, _MAP)
        info = self._make(
            "nav_msgs/msg/MapMetaData",
            map_load_time=header.stamp,
            resolution=grid.resolution,
            width=grid.width,
            height=grid.height,
            origin=self._pose((*grid.origin, 0.0)),
        )
        return self._make(_TOPICS["/map"], header=header, info=info, data=grid.cells.astype(np.int8).ravel())

    def path(self, stamp: int, stamps: list[int], poses: list[Pose]) -> Any:
        """nav_msgs/Path."""
        stamped = [
            self._make("geometry_msgs/msg/PoseStamped", header=self._header(at, _MAP), pose=self._pose(pose))
            for at, pose in zip(stamps, poses, strict=True)
        ]
        return self._make(_TOPICS["/trajectory"], header=self._header(stamp, _MAP), poses=stamped)

    def transform(self, stamp: int, pose: Pose) -> Any:
        """tf2_msgs/TFMessage of the sensor on the map."""
        x, y, theta = pose
        transform = self._make(
            "geometry_msgs/msg/Transform",
            translation=self._make("geometry_msgs/msg/Vector3", x=x, y=y, z=0.0),
            rotation=self._rotation(theta),
        )
        header = self._header(stamp, _MAP)
        stamped = self._make(
            "geometry_msgs/msg/TransformStamped", header=header, child_frame_id=_SENSOR, transform=transform
        )
        return self._make(_TOPICS["/tf"], transforms=[stamped])

    def points(self, stamp: int, points: np.ndarray[Any, np.dtype[np.float64]]) -> Any:
        """sensor_msgs/PointCloud2 in the sensor's frame."""
        cells = np.zeros((len(points), 3), dtype="<f4")
        cells[:, :2] = points
        fields = [
            self._make("sensor_msgs/msg/PointField", name=name, offset=4 * k, datatype=7, count=1)
            for k, name in enumerate("xyz")
        ]
        return self._make(
            _TOPICS["/points"],
            header=self._header(stamp, _SENSOR),
            height=1,
            width=len(cells),
            fields=fields,
            is_bigendian=False,
            point_step=12,
            row_step=12 * len(cells),
            data=np.frombuffer(cells.tobytes(), dtype=np.uint8),
            is_dense=True,
        )
