# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""ros2 launch oort online_launch.py: the mapping node, with tf under the namespace if one is given."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

CONFIG = Path(get_package_share_directory("oort")) / "config" / "mapping.yaml"
ARGUMENTS = {
    "use_sim_time": ("false", "take the time from /clock"),
    "params_file": (str(CONFIG), "a YAML file of parameters"),
    "namespace": ("", "of the robot, where there are several"),
    "scan_topic": ("scan", "of the laser"),
    "base_frame": ("base_footprint", "of the robot; base_link where there is no other"),
    "imu_topic": ("imu", "of the IMU, read if use_imu is true"),
    "name": ("oort_slam", "of the node, which its services begin with"),
}


def generate_launch_description() -> LaunchDescription:
    """The node and its arguments."""
    node = Node(
        package="oort",
        executable="oort_ros",
        name=LaunchConfiguration("name"),
        namespace=LaunchConfiguration("namespace"),
        output="screen",
        parameters=[
            LaunchConfiguration("params_file"),
            {name: LaunchConfiguration(name) for name in ("use_sim_time", "base_frame")},
        ],
        remappings=[
            ("/tf", "tf"),
            ("/tf_static", "tf_static"),
            ("scan", LaunchConfiguration("scan_topic")),
            ("imu", LaunchConfiguration("imu_topic")),
        ],
        sigterm_timeout="20",  # the map is saved at the end
    )
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    return LaunchDescription([*declared, node])
