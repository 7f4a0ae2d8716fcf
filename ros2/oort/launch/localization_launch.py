# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""ros2 launch oort localization_launch.py map:=/maps/home: the localiser, in the place of amcl and map_server."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LifecycleNode

CONFIG = Path(get_package_share_directory("oort")) / "config" / "localization.yaml"
ARGUMENTS = {
    "use_sim_time": ("false", "take the time from /clock"),
    "params_file": (str(CONFIG), "a YAML file of parameters"),
    "namespace": ("", "of the robot, where there are several"),
    "autostart": ("true", "activate itself; false for a lifecycle manager that does so"),
    "scan_topic": ("scan", "of the laser"),
    "base_frame": ("base_footprint", "of the robot; base_link where there is no other"),
    "start": ("auto", "where it begins: auto, last, dock or global"),
    "name": ("oort_localizer", "of the node, which its services begin with"),
}


def generate_launch_description() -> LaunchDescription:
    """The node and its arguments."""
    node = LifecycleNode(
        package="oort",
        executable="oort_localizer",
        name=LaunchConfiguration("name"),
        namespace=LaunchConfiguration("namespace"),
        output="screen",
        parameters=[
            LaunchConfiguration("params_file"),
            {name: LaunchConfiguration(name) for name in ("use_sim_time", "autostart", "base_frame", "map", "start")},
        ],
        remappings=[("/tf", "tf"), ("/tf_static", "tf_static"), ("scan", LaunchConfiguration("scan_topic"))],
        sigterm_timeout="20",  # the pose is saved at the end
    )
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    given = DeclareLaunchArgument("map", description="base path of the saved map, without ending")
    return LaunchDescription([given, *declared, node])
