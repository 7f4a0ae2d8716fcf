# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Writes small recordings for tests."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore


def flaser(
    stamp: str, ranges: Sequence[float], laser: Sequence[float] = (0, 0, 0), robot: Sequence[float] | None = None
) -> str:
    """A FLASER line without its end."""
    poses = " ".join(f"{value:.6f}" for value in (*laser, *(laser if robot is None else robot)))
    readings = " ".join(f"{value:.2f}" for value in ranges)
    return f"FLASER {len(ranges)} {readings} {poses} {stamp} host 0.5"


def yaw_quaternion(yaw: float) -> tuple[float, float, float, float]:
    return 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)


def roll_yaw_quaternion(roll: float, yaw: float) -> tuple[float, float, float, float]:
    """First the roll about x, then the yaw about z."""
    cr, sr, cy, sy = math.cos(roll / 2), math.sin(roll / 2), math.cos(yaw / 2), math.sin(yaw / 2)
    return sr * cy, sr * sy, cr * sy, cr * cy


@dataclass
class Bag:
    """Collects messages in their order and writes them as any kind of bag."""

    messages: list[tuple[float, str, str, dict[str, Any]]] = field(default_factory=list)

    def scan(
        self,
        time: float,
        topic: str = "/scan",
        frame: str = "laser",
        ranges: Sequence[float] = (1.0, 2.0, 3.0),
        time_increment: float = 0.0,
    ) -> "Bag":
        content = {
            "header": {"time": time, "frame": frame},
            "angles": (-0.5, 0.5, 0.25),
            "ranges": np.array(ranges, dtype=np.float32),
            "time_increment": time_increment,
        }
        self.messages.append((time, topic, "sensor_msgs/msg/LaserScan", content))
        return self

    def echoes(
        self, time: float, topic: str = "/scan", beams: Sequence[Sequence[float]] = ((1.0,), (2.0, 4.0))
    ) -> "Bag":
        """A scan with several echoes of each beam."""
        content = {
            "header": {"time": time, "frame": "laser"},
            "angles": (-0.5, 0.5, 0.25),
            "echoes": beams,
            "time_increment": 0.0,
        }
        self.messages.append((time, topic, "sensor_msgs/msg/MultiEchoLaserScan", content))
        return self

    def tf(
        self,
        time: float,
        parent: str,
        child: str,
        xyz: Sequence[float] = (0, 0, 0),
        quaternion: Sequence[float] = (0, 0, 0, 1),
        topic: str = "/tf",
    ) -> "Bag":
        content = {"header": {"time": time, "frame": parent}, "child": child, "xyz": xyz, "q": quaternion}
        self.messages.append((time, topic, "tf2_msgs/msg/TFMessage", content))
        return self

    def odometry(
        self,
        time: float,
        pose: Sequence[float],
        frame: str = "odom",
        child: str = "base",
        topic: str = "/odom",
    ) -> "Bag":
        x, y, yaw = pose
        content = {
            "header": {"time": time, "frame": frame},
            "child": child,
            "xyz": (x, y, 0),
            "q": yaw_quaternion(yaw),
        }
        self.messages.append((time, topic, "nav_msgs/msg/Odometry", content))
        return self

    def imu(
        self, time: float, rate: Sequence[float], frame: str = "base", topic: str = "/imu", told: bool = True
    ) -> "Bag":
        content = {"header": {"time": time, "frame": frame}, "rate": rate, "told": told}
        self.messages.append((time, topic, "sensor_msgs/msg/Imu", content))
        return self

    def ros1(self, path: Path) -> Path:
        """Writes a ROS 1 bag."""
        with Writer1(path) as writer:
            self._write(writer, Stores.ROS1_NOETIC)
        return path

    def ros2(self, path: Path, storage: StoragePlugin) -> Path:
        """Writes a ROS 2 bag, a directory."""
        with Writer2(path, version=9, storage_plugin=storage) as writer:
            self._write(writer, Stores.ROS2_HUMBLE)
        return path

    def _write(self, writer: Any, store: Stores) -> None:
        types = get_typestore(store)
        is1 = store is Stores.ROS1_NOETIC
        if "tf2_msgs/msg/TFMessage" not in types.types:
            types.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage"))
        connections = {}
        for order, (_, topic, kind, content) in enumerate(self.messages):
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=types)
            message = _message(types.types, kind, content, is1)
            raw = types.serialize_ros1(message, kind) if is1 else types.serialize_cdr(message, kind)
            writer.write(connections[topic], (100 + order) * 10**9, raw)


def _message(t: Any, kind: str, content: dict[str, Any], is1: bool) -> Any:
    time, frame = content["header"]["time"], content["header"]["frame"]
    sec = math.floor(time)
    stamp = t["builtin_interfaces/msg/Time"](sec=sec, nanosec=round((time - sec) * 1e9))
    header = t["std_msgs/msg/Header"](stamp=stamp, frame_id=frame, **({"seq": 0} if is1 else {}))
    if kind in ("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/MultiEchoLaserScan"):
        first, last, step = content["angles"]
        echo = t["sensor_msgs/msg/LaserEcho"]
        several = [echo(echoes=np.array(beam, dtype=np.float32)) for beam in content.get("echoes", [])]
        return t[kind](
            header=header,
            angle_min=first,
            angle_max=last,
            angle_increment=step,
            time_increment=content["time_increment"],
            scan_time=0.1,
            range_min=0.1,
            range_max=5.5,
            ranges=several or content["ranges"],
            intensities=[] if several else np.zeros(0, dtype=np.float32),
        )
    if kind == "sensor_msgs/msg/Imu":
        vector = t["geometry_msgs/msg/Vector3"]
        rx, ry, rz = map(float, content["rate"])
        return t[kind](
            header=header,
            orientation=t["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=0.0, w=1.0),
            orientation_covariance=np.zeros(9),
            angular_velocity=vector(x=rx, y=ry, z=rz),
            angular_velocity_covariance=np.array([0.0 if content["told"] else -1.0, *np.zeros(8)]),
            linear_acceleration=vector(x=0.0, y=0.0, z=0.0),
            linear_acceleration_covariance=np.zeros(9),
        )
    qx, qy, qz, qw = map(float, content["q"])
    rotation = t["geometry_msgs/msg/Quaternion"](x=qx, y=qy, z=qz, w=qw)
    x, y, z = map(float, content["xyz"])
    if kind == "tf2_msgs/msg/TFMessage":
        vector = t["geometry_msgs/msg/Vector3"](x=x, y=y, z=z)
        transform = t["geometry_msgs/msg/Transform"](translation=vector, rotation=rotation)
        item = t["geometry_msgs/msg/TransformStamped"](
            header=header, child_frame_id=content["child"], transform=transform
        )
        return t[kind](transforms=[item])
    point = t["geometry_msgs/msg/Point"](x=x, y=y, z=z)
    pose = t["geometry_msgs/msg/Pose"](position=point, orientation=rotation)
    zero = t["geometry_msgs/msg/Vector3"](x=0.0, y=0.0, z=0.0)
    twist = t["geometry_msgs/msg/Twist"](linear=zero, angular=zero)
    return t[kind](
        header=header,
        child_frame_id=content["child"],
        pose=t["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=np.zeros(36)),
        twist=t["geometry_msgs/msg/TwistWithCovariance"](twist=twist, covariance=np.zeros(36)),
    )
