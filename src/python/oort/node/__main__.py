# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.node`` or ``rosrun oort oort_ros``: the mapping node."""

import sys

try:
    import rospy
    import tf2_ros  # noqa: F401
except ImportError as error:
    sys.exit(
        f"oort_ros: {error}. The node needs Debian's ROS packages (scripts/setup.sh --ros) and a Python made from "
        f"/usr/bin/python3 with its site packages; this is {sys.executable}"
    )

from oort.events import EventLog
from oort.node.node import Node
from oort.node.running import run_node
from oort.node.settings import read_settings


def _begin() -> Node:
    settings = read_settings()
    event_log = EventLog(settings.events_log) if settings.events_log else None
    node = Node(settings.parameters, event_log, settings.limits)
    try:
        if settings.load:
            node.live.call("map/load", [settings.load])
    except BaseException:
        node.close()
        raise
    rospy.loginfo("%s is ready; mapping begins with %s/map/start", rospy.get_name(), rospy.get_name())
    return node


def main() -> int:
    """Runs the node until it is told to end, then saves the map; exit code 2 if it cannot begin."""
    return run_node("oort_slam", _begin)


if __name__ == "__main__":
    sys.exit(main())
