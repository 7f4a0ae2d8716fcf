# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.node`` or ``rosrun oort oort_ros``: the mapping node."""

import sys

from oort.events import EventLog
from oort.node.logs import log
from oort.node.middleware import Closable, Middleware, find
from oort.node.running import run_node
from oort.node.settings import read_settings


def _begin(middleware: Middleware) -> Closable:
    from oort.node.node import Node  # needs the messages of a ROS, of which main() has made sure

    settings = read_settings(middleware, ["load", "events_log"])
    events, load = settings.own["events_log"], settings.own["load"]
    node = Node(middleware, settings.parameters, EventLog(events) if events else None, settings.limits)
    try:
        if settings.view is not None:
            node.show_view(settings.view)
        if load:
            node.live.call("map/load", [load])
    except BaseException:
        node.close()
        raise
    log.info("%s is ready; mapping begins with %s/map/start", middleware.name, middleware.name)
    return node


def main() -> int:
    """Runs the node until it is told to end, then saves the map; exit code 2 if it cannot begin."""
    return run_node(find("oort_ros")("oort_slam"), _begin)


if __name__ == "__main__":
    sys.exit(main())
