# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the nodes need of ROS (base), over rospy for ROS 1 and over rclpy for ROS 2; only here are these imported."""

import importlib.util
import os
import sys

from oort.node.middleware.base import Closable, Managed, Middleware, Publisher, Quality, Subscription

__all__ = ["Closable", "Managed", "Middleware", "Publisher", "Quality", "Subscription", "find"]

_LIBRARIES = {"1": "rospy", "2": "rclpy"}


def find(program: str, managed: bool = False) -> type[Middleware]:
    """The middleware of the ROS that is there; where both are, of the one that ROS_VERSION names, else ROS 1.

    ``managed``: whether a node in ROS 2 has a lifecycle. Without any ROS, ends the program with a sentence that says
    what to do.
    """
    wanted = os.environ.get("ROS_VERSION", "")
    versions = [wanted] if wanted in _LIBRARIES else list(_LIBRARIES)
    found = [version for version in versions if importlib.util.find_spec(_LIBRARIES[version]) is not None]
    if not found:
        missing = " and ".join(f"no module named {_LIBRARIES[version]!r}" for version in versions)
        sys.exit(
            f"{program}: {missing}. The node needs ROS 2, whose setup.bash is to be sourced (docs/ros2.md), or for "
            "ROS 1 Debian's packages (scripts/setup.sh --ros) and a Python made from /usr/bin/python3 with its site "
            f"packages; this is {sys.executable}"
        )
    if found[0] == "1":
        from oort.node.middleware.rospy import Rospy

        return Rospy
    from oort.node.middleware.rclpy import Rclpy
    from oort.node.middleware.rclpy_lifecycle import ManagedRclpy

    return ManagedRclpy if managed else Rclpy
