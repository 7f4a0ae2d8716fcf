# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m oort.node.localizer`` or ``rosrun oort oort_localizer``: the localiser."""

import sys

from oort.errors import InputError
from oort.node.logs import log
from oort.node.middleware import Managed, Middleware, find
from oort.node.running import run_node
from oort.node.settings import read_settings


def _begin(middleware: Middleware) -> Managed:
    from oort.node.localizer_node import STARTS, LocalizerNode  # needs the messages of a ROS, see main()

    settings = read_settings(middleware, ["map", "start"])
    base, start = settings.own["map"], settings.own["start"] or "auto"
    if not base or start not in STARTS:
        named = middleware.parameter_name
        raise InputError(
            f"{named('map')} must be the path of a saved map, and {named('start')} one of {', '.join(STARTS)}"
        )
    node = LocalizerNode(middleware, settings.parameters, base, start, settings.limits)
    log.info("%s is ready", middleware.name)
    return node


def main() -> int:
    """Runs the node until it is told to end; exit code 2 if it cannot begin."""
    return run_node(find("oort_localizer", managed=True)("oort_localizer"), _begin)


if __name__ == "__main__":
    sys.exit(main())
