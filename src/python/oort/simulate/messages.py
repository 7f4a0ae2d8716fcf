# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated drive as messages of ROS: what the robot's own nodes would have published."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from oort.poses import Array, between
from oort.simulate.drive import REAR_STEPS, STEPS_PER_SCAN, Drive, rear_mount
from oort.simulate.driver import STEP

ODOM_FRAME, BASE_FRAME, SENSOR_FRAME = "odom", "base_footprint", "hokuyo_laser_link"
TF_STATIC = "/tf_static"
IMU = "/imu"
REAR, REAR_FRAME = "/scan_rear", "rear_laser_link"
_TOPICS = {
    TF_STATIC: "tf2_msgs/msg/TFMessage",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/odom": "nav_msgs/msg/Odometry",
    "/scan": "sensor_msgs/msg/LaserScan",
}


def topics_of(drive: Drive) -> dict[str, str]:
    """The topics of a drive with their types.

    /scan at 10 Hz, /tf (odom to base) and /odom at 50 Hz and once /tf_static (base to sensor). A robot with a gyro has
    /imu at 50 Hz as well, one with a sensor that looks back /scan_rear at 10 Hz.
    """
    topics = _TOPICS | ({IMU: "sensor_msgs/msg/Imu"} if len(drive.gyro) else {})
    return topics | ({REAR: _TOPICS["/scan"]} if len(drive.rear_ranges) else {})


class Messages:
    """Makes the messages of a drive from a typestore's message classes."""

    def __init__(self, types: dict[str, Any], drive: Drive, *, of_ros1: bool) -> None:
        """Of a ROS 1 store's types, or a ROS 2 store's."""
        self._types, self._drive, self._of_ros1 = types, drive, of_ros1

    def all(self) -> Iterator[tuple[str, int, Any]]:
        """Topic, stamp [ns] and message, by stamp; of the same stamp, transforms come first and the scan last."""
        drive = self._drive
        stamps = [int(stamp) for stamp in drive.odometry_stamps]
        yield TF_STATIC, stamps[0], self._mount(stamps[0], SENSOR_FRAME, drive.T_base_sensor)
        if len(drive.rear_ranges):
            yield TF_STATIC, stamps[0], self._mount(stamps[0], REAR_FRAME, np.array(rear_mount(drive.config.sensor)))
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
        own = {"seq": seq} if self._of_ros1 else {}
        return self._types["std_msgs/msg/Header"](stamp=time, frame_id=frame, **own)

    def _vector(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Any:
        return self._types["geometry_msgs/msg/Vector3"](x=x, y=y, z=z)

    def _rotation(self, heading: float, tilt: float = 0.0) -> Any:
        """Of something that looks down by ``tilt`` [rad]."""
        (sin_h, cos_h), (sin_t, cos_t) = ((float(np.sin(0.5 * a)), float(np.cos(0.5 * a))) for a in (heading, tilt))
        return self._types["geometry_msgs/msg/Quaternion"](
            x=0.0 - sin_h * sin_t, y=cos_h * sin_t, z=sin_h * cos_t, w=cos_h * cos_t
        )

    def _mount(self, stamp: int, frame: str, pose: Array) -> Any:
        sensor = self._drive.config.sensor
        return self._transform(0, stamp, BASE_FRAME, frame, pose, sensor.height, sensor.tilt)

    def _transform(
        self, seq: int, stamp: int, parent: str, child: str, pose: Array, height: float = 0.0, tilt: float = 0.0
    ) -> Any:
        x, y, heading = pose.tolist()
        transform = self._types["geometry_msgs/msg/Transform"](
            translation=self._vector(x, y, height), rotation=self._rotation(heading, tilt)
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
