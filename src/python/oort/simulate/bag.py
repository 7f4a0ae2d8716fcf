# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated drive as a ROS 1 bag: what the robot's own nodes would have published."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from oort.poses import Array, between
from oort.simulate.drive import REAR_STEPS, STEPS_PER_SCAN, Drive, rear_mount
from oort.simulate.driver import STEP

ODOM_FRAME, BASE_FRAME, SENSOR_FRAME = "odom", "base_footprint", "hokuyo_laser_link"
CALLER = "/simulate"
TOPICS = {
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/odom": "nav_msgs/msg/Odometry",
    "/scan": "sensor_msgs/msg/LaserScan",
}
IMU = "/imu"
REAR, REAR_FRAME = "/scan_rear", "rear_laser_link"


def write_bag(drive: Drive, path: Path) -> None:
    """Write /scan at 10 Hz, /tf (odom to base) and /odom at 50 Hz and once /tf_static (base to sensor), by stamp.

    A robot with a gyro has /imu at 50 Hz as well, one with a sensor that looks back /scan_rear at 10 Hz.

    The file must not exist yet. Of messages with the same stamp, transforms come first and the scan last.
    """
    store = get_typestore(Stores.ROS1_NOETIC)
    store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms\n", "tf2_msgs/msg/TFMessage"))
    topics = TOPICS | ({IMU: "sensor_msgs/msg/Imu"} if len(drive.gyro) else {})
    topics |= {REAR: TOPICS["/scan"]} if len(drive.rear_ranges) else {}
    with Writer(path) as writer:
        connections = {
            topic: writer.add_connection(
                topic, kind, typestore=store, callerid=CALLER, latching=int(topic == "/tf_static")
            )
            for topic, kind in topics.items()
        }
        for topic, stamp, message in _Messages(store.types, drive).all():
            writer.write(connections[topic], stamp, store.serialize_ros1(message, topics[topic]))


class _Messages:
    """Makes the messages of a drive from a typestore's message classes."""

    def __init__(self, types: dict[str, Any], drive: Drive) -> None:
        self._types, self._drive = types, drive

    def all(self) -> Iterator[tuple[str, int, Any]]:
        """Topic, stamp [ns] and message, in the bag's order."""
        drive = self._drive
        stamps = [int(stamp) for stamp in drive.odometry_stamps]
        yield "/tf_static", stamps[0], self._transform(0, stamps[0], BASE_FRAME, SENSOR_FRAME, drive.T_base_sensor)
        if len(drive.rear_ranges):
            mount = np.array(rear_mount(drive.config.sensor))
            yield "/tf_static", stamps[0], self._transform(0, stamps[0], BASE_FRAME, REAR_FRAME, mount)
        moved = between(drive.T_odom_base[:-1], drive.T_odom_base[1:]) / STEP
        speeds = np.vstack([np.zeros(3), moved])
        for seq, stamp in enumerate(stamps):
            pose = drive.T_odom_base[seq]
            yield "/tf", stamp, self._transform(seq, stamp, ODOM_FRAME, BASE_FRAME, pose)
            yield "/odom", stamp, self._odometry(seq, stamp, pose, speeds[seq])
            if len(drive.gyro):
                yield IMU, stamp, self._imu(seq, stamp, float(drive.gyro[seq]))
            if seq % STEPS_PER_SCAN == 0:
                yield "/scan", stamp, self._scan(seq // STEPS_PER_SCAN, stamp, drive.ranges, SENSOR_FRAME)
            if seq % STEPS_PER_SCAN == REAR_STEPS and seq // STEPS_PER_SCAN < len(drive.rear_ranges):
                yield REAR, stamp, self._scan(seq // STEPS_PER_SCAN, stamp, drive.rear_ranges, REAR_FRAME)

    def _header(self, seq: int, stamp: int, frame: str) -> Any:
        time = self._types["builtin_interfaces/msg/Time"](sec=stamp // 10**9, nanosec=stamp % 10**9)
        return self._types["std_msgs/msg/Header"](seq=seq, stamp=time, frame_id=frame)

    def _vector(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Any:
        return self._types["geometry_msgs/msg/Vector3"](x=x, y=y, z=z)

    def _rotation(self, heading: float) -> Any:
        half = 0.5 * heading
        return self._types["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=float(np.sin(half)), w=float(np.cos(half)))

    def _transform(self, seq: int, stamp: int, parent: str, child: str, pose: Array) -> Any:
        x, y, heading = pose.tolist()
        transform = self._types["geometry_msgs/msg/Transform"](
            translation=self._vector(x, y), rotation=self._rotation(heading)
        )
        stamped = self._types["geometry_msgs/msg/TransformStamped"](
            header=self._header(seq, stamp, parent), child_frame_id=child, transform=transform
        )
        return self._types["tf2_msgs/msg/TFMessage"](transforms=[stamped])

    def _odometry(self, seq: int, stamp: int, pose: Array, speed: Array) -> Any:
        x, y, heading = pose.tolist()
        unknown = np.zeros(36)
        place = self._types["geometry_msgs/msg/Pose"](
            position=self._types["geometry_msgs/msg/Point"](x=x, y=y, z=0.0), orientation=self._rotation(heading)
        )
        twist = self._types["geometry_msgs/msg/Twist"](
            linear=self._vector(float(speed[0])), angular=self._vector(z=float(speed[2]))
        )
        return self._types["nav_msgs/msg/Odometry"](
            header=self._header(seq, stamp, ODOM_FRAME),
            child_frame_id=BASE_FRAME,
            pose=self._types["geometry_msgs/msg/PoseWithCovariance"](pose=place, covariance=unknown),
            twist=self._types["geometry_msgs/msg/TwistWithCovariance"](twist=twist, covariance=unknown),
        )

    def _imu(self, seq: int, stamp: int, yaw_rate: float) -> Any:
        unknown = np.array([-1.0, *np.zeros(8)])
        return self._types["sensor_msgs/msg/Imu"](
            header=self._header(seq, stamp, BASE_FRAME),
            orientation=self._rotation(0.0),
            orientation_covariance=unknown,
            angular_velocity=self._vector(z=yaw_rate),
            angular_velocity_covariance=np.zeros(9),
            linear_acceleration=self._vector(),
            linear_acceleration_covariance=unknown,
        )

    def _scan(self, index: int, stamp: int, ranges: npt.NDArray[np.float32], frame: str) -> Any:
        drive = self._drive
        return self._types["sensor_msgs/msg/LaserScan"](
            header=self._header(index, stamp, frame),
            angle_min=drive.angle_min,
            angle_max=drive.angle_min + (drive.ranges.shape[1] - 1) * drive.angle_increment,
            angle_increment=drive.angle_increment,
            time_increment=drive.config.sensor.time_increment,
            scan_time=STEP * STEPS_PER_SCAN,
            range_min=drive.range_min,
            range_max=drive.range_max,
            ranges=ranges[index],
            intensities=np.empty(0, dtype=np.float32),
        )
