# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.ros`` or ``rosrun oort oort_ros``: the mapping node."""

import signal
import sys
import threading

try:
    import rospy
    import tf2_ros  # noqa: F401
except ImportError as error:
    sys.exit(
        f"oort_ros: {error}. The node needs Debian's ROS packages (scripts/setup.sh --ros) and a Python made from "
        f"/usr/bin/python3 with its site packages; this is {sys.executable}"
    )

from oort.errors import OortError
from oort.events import EventLog
from oort.ros.node import Node
from oort.ros.settings import read_settings


def main() -> int:
    """Runs the node until it is told to end, then saves the map; exit code 2 if it cannot begin."""
    rospy.init_node("oort_slam", disable_signals=True)
    # rospy's own handler talks to the master, which hangs for ever where this thread is just doing so.
    told_to_end = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: told_to_end.set())
    try:
        settings = read_settings()
        event_log = EventLog(settings.events_log) if settings.events_log else None
        node = Node(settings.parameters, event_log)
        try:
            if settings.load:
                node.live.call("map/load", [settings.load])
            rospy.loginfo("%s is ready; mapping begins with %s/map/start", rospy.get_name(), rospy.get_name())
            while not told_to_end.wait(0.1) and not rospy.is_shutdown():
                pass
        finally:
            node.close()
    except OortError as error:
        rospy.logfatal("%s", error)
        return 2
    finally:
        rospy.signal_shutdown("the node ends")
    return 0


if __name__ == "__main__":
    sys.exit(main())
